#include "demo/felt_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kLagStep = 0.02e-3; // [m]

struct Window {
  double lag = 0;
  double whole = 0, variation = 0, truth = 0, varied = 0; // sums of squares
};

class Felt {
 public:
  explicit Felt(const std::vector<FeltPoint>& points) : points_(points) {}

  // Straight between the points.
  Vec3 at(double along) const {
    const auto next =
        std::lower_bound(points_.begin() + 1, points_.end() - 1, along,
                         [](const FeltPoint& point, double x) { return point.along < x; });
    const FeltPoint &a = *(next - 1), &b = *next;
    const double share = std::clamp((along - a.along) / (b.along - a.along), 0., 1.);
    return (1 - share) * a.felt + share * b.felt;
  }

 private:
  const std::vector<FeltPoint>& points_;
};

Window compared(const std::vector<FeltPoint>& points, std::size_t first, std::size_t last,
                double lag) {
  const Felt felt(points);
  const double n = static_cast<double>(last - first);
  double mean_felt = 0, mean_true = 0;
  std::vector<double> outward, truth;
  Window window;
  window.lag = lag;
  for (std::size_t i = first; i < last; ++i) {
    const FeltPoint& point = points[i];
    const Vec3 here = felt.at(point.along + lag);
    window.whole += (here - point.truth).squaredNorm();
    window.truth += point.truth.squaredNorm();
    outward.push_back(here.dot(point.outward));
    truth.push_back(point.truth.dot(point.outward));
    mean_felt += outward.back() / n;
    mean_true += truth.back() / n;
  }
  for (std::size_t i = 0; i < outward.size(); ++i) {
    const double varied = truth[i] - mean_true;
    window.variation += std::pow(outward[i] - mean_felt - varied, 2);
    window.varied += varied * varied;
  }
  return window;
}

} // namespace

FeltError feltError(const std::vector<FeltPoint>& points, double window, double most_lag) {
  FeltError error;
  Window sum;
  double count = 0;
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    while (last < points.size() && points[last].along - points[first].along < window) ++last;
    if (last == points.size()) break;
    Window best;
    best.variation = std::numeric_limits<double>::infinity();
    for (double lag = -most_lag; lag <= most_lag; lag += kLagStep)
      if (const Window tried = compared(points, first, last, lag); tried.variation < best.variation)
        best = tried;
    error.lag = std::max(error.lag, std::abs(best.lag));
    sum.whole += best.whole;
    sum.truth += best.truth;
    sum.variation += best.variation;
    sum.varied += best.varied;
    count += static_cast<double>(last - first);
    ++error.windows;
  }
  if (error.windows == 0) throw Error("the way is shorter than a window of it");
  error.whole = std::sqrt(sum.whole / sum.truth);
  error.variation = std::sqrt(sum.variation / sum.varied);
  error.true_variation = std::sqrt(sum.varied / count);
  return error;
}

} // namespace patina
