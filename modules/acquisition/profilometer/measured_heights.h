// Heights that a profilometer measured, and the files that hold them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// Heights along a line or over an area; all are finite [m].
struct MeasuredHeights {
  std::size_t columns = 0, rows = 1; // a profile has one row
  double step_x = 0, step_y = 0;     // spacing of an area [m]
  std::vector<double> along;         // position of each height of a profile, increasing [m]
  std::vector<double> heights;       // row by row, row 0 at y = 0 [m]
  bool isArea() const { return rows > 1; }
};

// A file has at most so many points.
inline constexpr std::size_t kMaxMeasuredPoints = std::size_t{1} << 24;
// More points than this share that were not measured are refused. Fewer are interpolated along the
// rows of an area; a profile does without them.
inline constexpr double kMaxUnmeasuredShare = 0.1;

// Returns whether a file begins as one of those that readMeasuredHeights() reads. Returns false for
// "-", a pipe, and what cannot be opened.
bool isProfilometerFile(const std::filesystem::path& path);

// Reads one of these formats, recognised by content:
//   X3P (ISO 25178-72:2017), a profile, a surface or a list of points, inline or binary;
//   SDF (ISO 25178-71 and BCR-1.0), as text or binary;
//   Gwyddion's text of an image;
//   a table with the columns x and z (or y), or x, y and z, in any units of length.
// `warnings` gets a line for each thing that was filled, left out or not checked; each begins with
// the file's name. Throws FileError: one line with the place and the remedy.
MeasuredHeights readMeasuredHeights(const std::filesystem::path& path,
                                    std::vector<std::string>& warnings);
// Reads the bytes of such a file; `name` is for messages.
MeasuredHeights parseMeasuredHeights(std::string_view bytes, const std::string& name,
                                     std::vector<std::string>& warnings);

} // namespace patina
