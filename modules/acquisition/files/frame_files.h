// Pictures of a camera and what is known of it, in a scan folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/camera.h"

namespace patina {

// Any picture that can be read, its brightness in 256 levels. Throws FileError.
GreyFrame readGrey(const std::filesystem::path& path);
// As a .png. Throws FileError.
void writeGrey(const std::filesystem::path& path, const GreyFrame& image);

// OpenCV's YAML: image_width, image_height, camera_matrix, distortion_coefficients of up to five
// numbers (k1 k2 p1 p2 k3). Throws FileError with the line.
Camera readCamera(const std::filesystem::path& path);
Camera parseCamera(const std::string& text, const std::string& name);
// `more` are lines for people and other programs, whole.
std::string cameraText(const Camera& camera, const std::string& more = "");

struct Frame {
  double t = 0;               // [s]
  std::filesystem::path file; // may be missing
};
// What frames.csv in the folder lists (frame,t [s]), each in frames/ as its number in six digits
// and whatever extension; without frames.csv all pictures of the folder or of frames/ in it by
// their names' order, `rate` a second. Throws FileError: no frame, time that does not increase, no
// rate.
std::vector<Frame> framesOf(const std::filesystem::path& folder, double rate);

// What frames.csv says, and how a frame's file is called.
struct FrameRow {
  int number;
  double t; // [s]
};
std::vector<FrameRow> parseFrameList(const std::string& text, const std::string& name);
std::string frameListHeader();
std::string frameStem(int number);

} // namespace patina
