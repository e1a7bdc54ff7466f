// Constants that many tests use.
#pragma once

#include <limits>
#include <numbers>

namespace patina::test {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod = 1e-3; // period of the servo [s]

} // namespace patina::test
