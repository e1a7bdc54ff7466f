// What a number in a table of measurements may be.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {

// What no value of a column, "x [m]", is beyond: 1e12, so that no sum of squares overflows. Of a
// time 1e10 s: clocks that count from 1970 are at 1.8e9, and far beyond a double no longer tells
// two samples of a fast probe apart.
inline double mostMeasured(std::string_view column) {
  return column.ends_with("[s]") ? 1e10 : 1e12;
}

// Throws FileError unless a value in SI units can have been measured: finite and no more than
// mostMeasured(). `what` it is: its column.
inline void requireMeasured(double value, const std::string& what, const std::string& name,
                            std::size_t line) {
  if (!std::isfinite(value)) throw FileError(name, line, what + " is not a finite number");
  if (std::abs(value) > mostMeasured(what))
    throw FileError(name, line, what + " is " + formatNumber(value) + ", which nothing measures");
}

// Appends a line about the columns that nobody reads, if the table has any.
inline void warnOfColumns(const CsvReader& reader, std::vector<std::string>* warnings) {
  if (const std::string line = reader.leftOut(); warnings && !line.empty())
    warnings->push_back(line);
}

} // namespace patina
