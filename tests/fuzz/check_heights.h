// Checks the contract of every reader of a profilometer's files.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/profilometer/measured_heights.h"
#include "core/error.h"

namespace patina::test {

// Heights can be fitted, or the reader throws a FileError of one line.
inline void checkHeights(std::string_view bytes) {
  std::vector<std::string> warnings;
  try {
    const MeasuredHeights measured = parseMeasuredHeights(bytes, "fuzz", warnings);
    const std::size_t count = measured.heights.size();
    if (count == 0 || count != measured.columns * measured.rows || count > kMaxMeasuredPoints)
      __builtin_trap();
    for (const double height : measured.heights)
      if (!std::isfinite(height)) __builtin_trap();
    if (measured.isArea() ? !measured.along.empty() : measured.along.size() != count)
      __builtin_trap();
    if (measured.isArea() && !(measured.step_x > 0 && measured.step_y > 0)) __builtin_trap();
    for (std::size_t i = 1; i < measured.along.size(); ++i)
      if (!(measured.along[i] >= measured.along[i - 1])) __builtin_trap();
  } catch (const FileError&) {
  }
}

} // namespace patina::test
