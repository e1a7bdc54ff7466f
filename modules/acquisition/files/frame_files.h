// Camera frames of a scan folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/values/camera.h"

namespace patina {

// Reads a picture as 8-bit grey, turned by its EXIF orientation. Throws FileError.
GreyFrame readGrey(const std::filesystem::path& path);
// Writes a .png. Throws FileError.
void writeGrey(const std::filesystem::path& path, const GreyFrame& image);

struct Frame {
  double t = 0;               // [s]
  std::filesystem::path file; // may not exist
};
// Lists the frames of a scan folder. With frames.csv (frame,t [s]) these are its rows, with files
// in frames/ named by six digits and any extension. Without it they are all pictures of the folder
// or its frames/, `rate` per second in natural order of their names. Pictures are recognised by
// content; a file that only has a picture's name is a damaged frame. `left_out` gets a line about
// other files. Throws FileError: no frame, time that does not increase, no rate.
std::vector<Frame> framesOf(const std::filesystem::path& folder, double rate,
                            std::string* left_out = nullptr);

// A row of frames.csv, and the file name of a frame.
struct FrameRow {
  int number;
  double t; // [s]
};
std::vector<FrameRow> parseFrameList(const std::string& text, const std::string& name);
std::string frameListHeader();
std::string frameStem(int number);

} // namespace patina
