#include "acquisition/recording/min_delay_clock.h"

#include <algorithm>

namespace patina {

double MinDelayClock::timeOf(double stamp, double arrival) {
  const bool first = last_stamp_ == kNever;
  const double passed = first ? 0 : stamp - last_stamp_;
  least_ = std::min(least_ + kClockDrift * passed, arrival - stamp);
  last_stamp_ = stamp;
  const double at_least = last_ + std::max(0.1 * passed, 1e-6); // stamps may jump back
  return last_ = first ? stamp + least_ : std::max(stamp + least_, at_least);
}

} // namespace patina
