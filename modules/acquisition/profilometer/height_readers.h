// The readers of the single formats, and what they share. Internal to this folder.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/profilometer/measured_heights.h"

namespace patina {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Heights as a file has them; kNotMeasured where there is none.
struct RawHeights {
  std::uint64_t columns = 0, rows = 1;
  double step_x = 0, step_y = 0;       // [m]; 0: not known
  std::vector<double> x, y, z;         // [m]; x and y are empty where steps are even;
  std::vector<std::string> warnings{}; // without the file's name
  bool is_list = false;                // points of an area in any order; columns is their number
};

// Each throws FileError(name).
RawHeights readX3p(std::string_view bytes, const std::string& name);
RawHeights readSdf(std::string_view bytes, const std::string& name);
RawHeights readGwyddionText(std::string_view bytes, const std::string& name);
RawHeights readHeightTable(std::string_view bytes, const std::string& name);

// Returns whether text begins with the comments that Gwyddion writes above a matrix or points.
bool isGwyddionText(std::string_view head);

// The number of points of a matrix. Throws FileError: none, or more than kMaxMeasuredPoints.
std::size_t countOfPoints(std::uint64_t columns, std::uint64_t rows, const std::string& name);

// Throws FileError unless a step can be that of an instrument: above 0 and at most 10 m.
void requireStep(double step, const std::string& what, const std::string& name);

// A number of `bytes`, which are in little-endian order as on all machines that Patina runs on.
template <class Number> double numberAt(std::string_view bytes, std::size_t offset) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return static_cast<double>(value);
}

// Words of a text, between blanks and ends of lines.
class WordReader {
 public:
  explicit WordReader(std::string_view text, std::size_t line = 1) : text_(text), line_(line) {}
  bool next(std::string_view& word);             // returns false at the end
  std::size_t line() const { return line_; }     // line of the last word, counted from 1
  bool beganLine() const { return began_line_; } // the last word was the first of its line

 private:
  std::string_view text_;
  std::size_t line_;
  bool began_line_ = true, at_start_ = true;
};

} // namespace patina
