// Pictures of a camera in a scan folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/camera.h"

namespace patina {

// Any picture that can be read, its brightness in 256 levels, turned as its EXIF says. Throws
// FileError.
GreyFrame readGrey(const std::filesystem::path& path);
// As a .png. Throws FileError.
void writeGrey(const std::filesystem::path& path, const GreyFrame& image);

struct Frame {
  double t = 0;               // [s]
  std::filesystem::path file; // may be missing
};
// What frames.csv in the folder lists (frame,t [s]), each in frames/ as its number in six digits
// and whatever extension; without frames.csv all pictures of the folder or of frames/ in it by
// their names' order, in which numbers count as numbers, `rate` a second. Pictures are told by
// their content; one that has a picture's name only is damaged, and a frame too. `left_out` gets a
// line about files that are neither, if there are any. Throws FileError: no frame, time that does
// not increase, no rate.
std::vector<Frame> framesOf(const std::filesystem::path& folder, double rate,
                            std::string* left_out = nullptr);

// What frames.csv says, and how a frame's file is called.
struct FrameRow {
  int number;
  double t; // [s]
};
std::vector<FrameRow> parseFrameList(const std::string& text, const std::string& name);
std::string frameListHeader();
std::string frameStem(int number);

} // namespace patina
