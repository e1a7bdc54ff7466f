// What a calibration says of a camera: OpenCV's YAML, XML or JSON, ROS's camera_info (a calibration
// file or a printed message), kalibr's camchain of one camera.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/camera.h"

namespace patina {

// The file's own words choose the lens model: distortion_model, fisheye_model, or the number of
// coefficients. Throws FileError with the line; a model that is not known is named with those that
// are.
Camera readCamera(const std::filesystem::path& path);
Camera parseCamera(const std::string& text, const std::string& name);

// OpenCV's YAML, which readCamera() reads back bit for bit. `more` are whole lines.
std::string cameraText(const Camera& camera, const std::string& more = "");

// "plumb_bob", "rational_polynomial", "thin prism", "tilted sensor" or "equidistant", by the
// coefficients that are not 0.
std::string lensName(const Camera& camera);

} // namespace patina
