// Nanoseconds of one query, from many.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace patina {

// The fastest of several passes: what else the machine does can only add.
template <class Point, class Query>
double nsPerQuery(const std::vector<Point>& points, const Query& query, int passes = 7) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity();
  double sum = 0; // keeps the calls alive
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = Clock::now();
    for (const Point& point : points) sum += query(point);
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    best = std::min(best, elapsed.count() / static_cast<double>(points.size()));
  }
  volatile double kept = sum;
  (void)kept;
  return best;
}

} // namespace patina
