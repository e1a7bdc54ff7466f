// The time of a source's samples on the clock of who receives them.
#pragma once

#include <limits>

namespace patina {

// What arrives is late by a delay that varies and is never negative; what a source stamps is even.
// So the source's stamps are taken, moved by the least that anything came late so far. The least
// grows by kClockDrift, as clocks differ by that much, and times go on at a tenth of their pace at
// least when a lesser one is found: they increase where stamps do.
class ArrivalClock {
 public:
  static constexpr double kClockDrift = 2e-4;

  double timeOf(double stamp, double arrival); // all [s]

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  double least_ = -kNever, last_stamp_ = kNever, last_ = kNever;
};

} // namespace patina
