// How a list of measured values spreads.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace patina {

struct Percentiles {
  double p50 = 0, p99 = 0, p999 = 0, max = 0;
};
// Nearest rank: the smallest value that at least the fraction of all does not exceed. Zeros for an
// empty list.
Percentiles percentiles(std::vector<double> values);
// The same of whole numbers that are counted, which takes room for each different one only.
Percentiles percentilesOfCounts(const std::map<std::uint32_t, std::size_t>& counts);

} // namespace patina
