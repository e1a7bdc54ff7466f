// How a list of measured values spreads.
#pragma once

#include <vector>

namespace patina {

struct Percentiles {
  double p50 = 0, p99 = 0, p999 = 0, max = 0;
};
// Nearest rank: the smallest value that at least the fraction of all does not exceed. Zeros for an
// empty list.
Percentiles percentiles(std::vector<double> values);

} // namespace patina
