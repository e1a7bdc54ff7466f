// How much faster a source's clock runs than that of who receives its stamps.
#pragma once

#include <optional>
#include <vector>

namespace patina {

// What arrives is late by a delay that varies and is never negative, so arrival - stamp lies above
// a line whose slope is the skew. Of the lines below all points the one nearest to their mean is an
// edge of their lower hull. The error is at most the least delays' spread over the time span.
class ClockSkew {
 public:
  static constexpr double kLeastSpan = 10; // [s]: before, nothing is said

  void add(double stamp, double arrival); // stamps in increasing order [s]
  // stamps = (1 + skew) * true times, those of arrivals.
  std::optional<double> skew() const;

 private:
  struct Point {
    double x, y;
  };
  static constexpr std::size_t kMostPoints = 1024; // of the hull: every other is then left out

  std::vector<Point> hull_;
};

} // namespace patina
