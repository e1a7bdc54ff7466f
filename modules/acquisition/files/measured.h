// What a number in a table of measurements may be.
#pragma once

#include <cmath>
#include <string>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {

// Throws FileError unless a value in SI units can have been measured: finite, and so small, 1e12,
// that no sum of squares overflows. `what` it is: "x [m]".
inline void requireMeasured(double value, const std::string& what, const std::string& name,
                            std::size_t line) {
  if (!std::isfinite(value)) throw FileError(name, line, what + " is not a finite number");
  if (std::abs(value) > 1e12)
    throw FileError(name, line, what + " is " + formatNumber(value) + ", which nothing measures");
}

} // namespace patina
