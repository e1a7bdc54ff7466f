// Camera calibration files: OpenCV's YAML, XML or JSON, ROS's camera_info (a calibration file or a
// printed message), kalibr's camchain of one camera.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/values/camera.h"

namespace patina {

// The lens model is chosen by distortion_model, fisheye_model, or the number of coefficients.
// Throws FileError with the line; the message for an unknown model lists the known ones.
Camera readCamera(const std::filesystem::path& path);
Camera parseCamera(const std::string& text, const std::string& name);

// Returns OpenCV's YAML, which readCamera() reads back bit for bit. `more` are complete lines.
std::string cameraText(const Camera& camera, const std::string& more = "");

// Returns "plumb_bob", "rational_polynomial", "thin prism", "tilted sensor" or "equidistant",
// according to the coefficients that are not 0.
std::string lensName(const Camera& camera);

} // namespace patina
