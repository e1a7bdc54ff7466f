#include "core/percentiles.h"

#include <algorithm>
#include <cmath>

namespace patina {

namespace {

// at(rank) returns the value of that rank, from 1.
template <class At> Percentiles ranked(std::size_t count, const At& at) {
  const auto nearest = [&](double fraction) {
    return at(
        static_cast<std::size_t>(std::max(std::ceil(fraction * static_cast<double>(count)), 1.0)));
  };
  return {nearest(0.5), nearest(0.99), nearest(0.999), at(count)};
}

} // namespace

Percentiles percentiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return ranked(values.size(), [&](std::size_t rank) { return values[rank - 1]; });
}

Percentiles percentilesOfCounts(const std::map<std::uint32_t, std::size_t>& counts) {
  if (counts.empty()) return {};
  std::size_t all = 0;
  for (const auto& [value, count] : counts) all += count;
  return ranked(all, [&](std::size_t rank) {
    auto at = counts.begin();
    for (; rank > at->second; ++at) rank -= at->second;
    return static_cast<double>(at->first);
  });
}

} // namespace patina
