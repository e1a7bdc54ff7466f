// Timing: nanoseconds per query, and processor time of longer work.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <vector>

namespace patina {

// Minimum over several passes, because other load can only add time.
template <class Point, class Query>
double nsPerQuery(const std::vector<Point>& points, const Query& query, int passes = 7) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity();
  double sum = 0; // keeps the calls from being optimised away
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

// Processor time of the calling thread [s].
inline double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace patina
