// Disjoint sets of numbers, each named by its lowest member (Galler & Fischer 1964). Internal to
// geometry.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/types.h"

namespace patina {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : up_(size) { std::iota(up_.begin(), up_.end(), 0); }

  // Returns the lowest member of the set of v. Halves the path for later calls.
  std::int32_t find(std::int32_t v) {
    while (up_[index(v)] != v) v = up_[index(v)] = up_[index(up_[index(v)])];
    return v;
  }
  void join(std::int32_t v, std::int32_t w) {
    const std::int32_t a = find(v), b = find(w);
    up_[index(std::max(a, b))] = std::min(a, b);
  }

  // Returns find() of each number.
  std::vector<std::int32_t> lowest() && {
    for (std::int32_t& v : up_) v = up_[index(v)]; // ascending, so that entries above v are final
    return std::move(up_);
  }

 private:
  std::vector<std::int32_t> up_;
};

} // namespace patina
