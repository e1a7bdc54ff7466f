#include "acquisition/profile/roughness.h"

#include <cmath>

namespace patina {
namespace {

constexpr std::size_t kPlacesAcross = 25; // samples per cutoff
constexpr std::size_t kMinLengths = 4;
constexpr double kMaxPlaces = 1e7;

// Interpolates the heights linearly at even steps.
std::vector<double> evenPlaces(const std::vector<ProfilePoint>& points, double step) {
  std::vector<double> heights;
  std::size_t next = 1;
  if (!(points.back().arc_length - points.front().arc_length < kMaxPlaces * step)) return {};
  for (double at = points.front().arc_length; at <= points.back().arc_length; at += step) {
    while (next + 1 < points.size() && points[next].arc_length < at) ++next;
    const ProfilePoint &a = points[next - 1], &b = points[next];
    heights.push_back(a.height +
                      (b.height - a.height) * (at - a.arc_length) / (b.arc_length - a.arc_length));
  }
  return heights;
}

// High-pass filter; removes half a cutoff at each end.
std::vector<double> withoutLongWaves(const std::vector<double>& heights) {
  const double alpha = std::sqrt(std::log(2.) / M_PI);
  constexpr std::size_t kHalf = kPlacesAcross / 2;
  std::vector<double> weights(2 * kHalf + 1);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(kHalf)) / kPlacesAcross;
    sum += weights[i] = std::exp(-M_PI * std::pow(x / alpha, 2));
  }
  std::vector<double> left;
  for (std::size_t i = kHalf; i + kHalf < heights.size(); ++i) {
    double mean = 0;
    for (std::size_t k = 0; k < weights.size(); ++k)
      mean += weights[k] * heights[i + k - kHalf] / sum;
    left.push_back(heights[i] - mean);
  }
  return left;
}

struct Averaged {
  double sum = 0, squares = 0, count = 0;
  void add(double value) { sum += value, squares += value * value, count += 1; }
  double value() const { return sum / count; }
  double deviation() const { // standard deviation of the mean
    return std::sqrt(std::max(squares / count - value() * value(), 0.) / (count - 1));
  }
};

} // namespace

std::optional<RoughnessEstimate> roughnessOf(const std::vector<ScanHeight>& heights,
                                             double cutoff) {
  Averaged squares, sizes;
  for (std::size_t begin = 0, end = 0; begin < heights.size(); begin = end) {
    std::vector<ProfilePoint> points; // points of increasing arc length; a stationary tip adds none
    for (; end < heights.size() && heights[end].stretch == heights[begin].stretch; ++end)
      if (points.empty() || heights[end].point.arc_length > points.back().arc_length)
        points.push_back(heights[end].point);
    if (points.size() < 2) continue;
    const std::vector<double> left = withoutLongWaves(evenPlaces(points, cutoff / kPlacesAcross));
    for (std::size_t first = 0; first + kPlacesAcross <= left.size(); first += kPlacesAcross) {
      double square = 0, size = 0;
      for (std::size_t i = first; i < first + kPlacesAcross; ++i) {
        square += left[i] * left[i] / kPlacesAcross;
        size += std::abs(left[i]) / kPlacesAcross;
      }
      squares.add(square);
      sizes.add(size);
    }
  }
  if (squares.count < kMinLengths) return std::nullopt;
  RoughnessEstimate found;
  found.rq = std::sqrt(squares.value());
  found.rq_deviation = found.rq > 0 ? squares.deviation() / (2 * found.rq) : 0;
  found.ra = sizes.value();
  found.ra_deviation = sizes.deviation();
  found.lengths = static_cast<std::size_t>(squares.count);
  return found;
}

} // namespace patina
