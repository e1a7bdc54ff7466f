// Converts a source's time stamps to the receiver's clock.
#pragma once

#include <limits>

namespace patina {

// Minimum-delay filter, as in NTP (Mills 1991). Transport delay is never negative, so the smallest
// delay seen so far gives the offset; it grows by kClockDrift to follow clock drift. Output times
// increase if stamps do: after a smaller delay, time runs on at a tenth of its rate or more.
class MinDelayClock {
 public:
  static constexpr double kClockDrift = 2e-4;

  double timeOf(double stamp, double arrival); // all [s]

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  double least_ = -kNever, last_stamp_ = kNever, last_ = kNever;
};

} // namespace patina
