// Plausibility limits of numbers in tables of measurements.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {

// Returns the largest accepted magnitude in a column such as "x [m]": 1e12, so that no sum of
// squares overflows. For times it is 1e10 s: Unix times are near 1.8e9, and much larger doubles
// cannot resolve the samples of a fast probe.
inline double maxPlausible(std::string_view column) {
  return column.ends_with("[s]") ? 1e10 : 1e12;
}

// Throws FileError if a value of the column `what` is not finite or exceeds maxPlausible().
inline void requireMeasured(double value, const std::string& what, const std::string& name,
                            std::size_t line) {
  if (!std::isfinite(value)) throw FileError(name, line, what + " is not a finite number");
  if (std::abs(value) > maxPlausible(what))
    throw FileError(name, line, what + " is " + formatNumber(value) + ", out of range");
}

// Appends a line about the columns that are not read, if the table has any.
inline void warnOfColumns(const CsvReader& reader, std::vector<std::string>* warnings) {
  if (const std::string line = reader.leftOut(); warnings && !line.empty())
    warnings->push_back(line);
}

} // namespace patina
