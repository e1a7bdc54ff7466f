#include "acquisition/sources/clock_skew.h"

#include <algorithm>

namespace patina {

void ClockSkew::add(double stamp, double arrival) {
  const Point point{stamp, arrival - stamp};
  const auto bendsDown = [&] { // the last point lies on or above the line about it
    const Point &a = hull_[hull_.size() - 2], &b = hull_.back();
    return (b.x - a.x) * (point.y - a.y) <= (b.y - a.y) * (point.x - a.x);
  };
  while (hull_.size() >= 2 && bendsDown()) hull_.pop_back();
  hull_.push_back(point);
  if (hull_.size() <= kMostPoints) return;
  std::size_t kept = 1;
  for (std::size_t i = 2; i + 1 < hull_.size(); i += 2) hull_[kept++] = hull_[i];
  hull_[kept++] = hull_.back();
  hull_.resize(kept);
}

std::optional<double> ClockSkew::skew() const {
  if (hull_.size() < 2 || hull_.back().x - hull_.front().x < kLeastSpan) return std::nullopt;
  const double mean = 0.5 * (hull_.front().x + hull_.back().x); // stamps are even
  const auto after = std::find_if(hull_.begin() + 1, hull_.end() - 1,
                                  [&](const Point& point) { return point.x >= mean; });
  const Point &a = after[-1], &b = *after;
  const double slope = (b.y - a.y) / (b.x - a.x); // 1 / (1 + skew) - 1
  return -slope / (1 + slope);
}

} // namespace patina
