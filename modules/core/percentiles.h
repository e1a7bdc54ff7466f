// Percentiles of measured values.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace patina {

struct Percentiles {
  double p50 = 0, p99 = 0, p999 = 0, max = 0;
};
// Nearest rank: smallest value that at least the fraction does not exceed; zeros without values.
Percentiles percentiles(std::vector<double> values);
// Same for a histogram of whole numbers, with one entry per distinct value.
Percentiles percentilesOfCounts(const std::map<std::uint32_t, std::size_t>& counts);

} // namespace patina
