#include "acquisition/texture/drawn_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr int kOrder = 3; // of the splines, and of the differences
constexpr int kBand = kOrder + 1;
constexpr double kKnots = 8; // in the length of a course
// Of the splines' own energy what a wave of that length has: 2 (1208 + 1191 cos u + 120 cos 2u +
// cos 3u) / 7!, u = 2 pi / kKnots.
constexpr double kEnergy = 0.8132766;
constexpr double kSlow = 1. / 4;      // of the median speed
constexpr double kBeyondCutoff = 1.5; // the course's length: a wave of the cutoff loses a twelfth

// Of a cubic B-spline, 0 to 1 between two knots.
std::array<double, kBand> blending(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
          u * u * u / 6};
}

// Rows of the lower half, each from the diagonal to the left; solved in place by Cholesky.
struct Banded {
  std::vector<std::array<double, kBand>> rows;
  std::vector<double> right;

  explicit Banded(std::size_t n) : rows(n), right(n) {}

  void add(std::size_t first, const std::array<double, kBand>& row, double weight, double value) {
    for (std::size_t a = 0; a < kBand; ++a) {
      right[first + a] += weight * row[a] * value;
      for (std::size_t b = 0; b <= a; ++b) rows[first + a][a - b] += weight * row[a] * row[b];
    }
  }
  std::vector<double> solve() {
    const std::size_t n = rows.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t d = std::min<std::size_t>(i, kOrder) + 1; d-- > 0;) {
        double sum = rows[i][d]; // between i and i - d
        for (std::size_t k = d + 1; k < kBand && k <= i; ++k)
          sum -= rows[i][k] * rows[i - d][k - d];
        rows[i][d] = d > 0 ? sum / rows[i - d][0] : std::sqrt(sum);
      }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t d = 1; d < kBand && d <= i; ++d) right[i] -= rows[i][d] * right[i - d];
      right[i] /= rows[i][0];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t d = 1; d < kBand && i + d < n; ++d)
        right[i] -= rows[i + d][d] * right[i + d];
      right[i] /= rows[i][0];
    }
    return right;
  }
};

} // namespace

std::vector<double> courseOf(const std::vector<double>& heights, const std::vector<double>& weights,
                             double step, double length) {
  const double knot = length / kKnots;
  const auto knots = static_cast<std::size_t>(static_cast<double>(heights.size()) * step / knot);
  Banded equations(knots + 1 + kOrder);
  const auto placeOf = [&](std::size_t i, double& u) {
    u = static_cast<double>(i) * step / knot;
    const auto first = static_cast<std::size_t>(u);
    u -= static_cast<double>(first);
    return first;
  };
  double u = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t first = placeOf(i, u);
    equations.add(first, blending(u), weights[i], heights[i]);
  }
  const double stiff =
      kEnergy * knot / step / std::pow(2 * std::sin(std::numbers::pi / kKnots), 2. * kOrder);
  for (std::size_t i = 0; i + kOrder < equations.rows.size(); ++i)
    equations.add(i, {-1, 3, -3, 1}, stiff, 0);
  const std::vector<double> factors = equations.solve();
  std::vector<double> course;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t first = placeOf(i, u);
    const std::array<double, kBand> shares = blending(u);
    double height = 0;
    for (std::size_t a = 0; a < kBand; ++a) height += shares[a] * factors[first + a];
    course.push_back(height);
  }
  return course;
}

std::vector<double> weightsBySpeed(const std::vector<double>& speeds) {
  const double slow = kSlow * percentiles(speeds).p50;
  if (!(slow > 0)) throw Error("over half of the profile the probe stands");
  std::vector<double> weights;
  for (const double speed : speeds) {
    const double known = std::pow(speed / slow, 3);
    weights.push_back(known / (1 + known));
  }
  return weights;
}

std::vector<double> drawnHeights(const std::vector<double>& heights,
                                 const std::vector<double>& speeds, double step, double cutoff) {
  const std::vector<double> weights = weightsBySpeed(speeds),
                            course = courseOf(heights, weights, step, kBeyondCutoff * cutoff);
  std::vector<double> texture;
  for (std::size_t i = 0; i < heights.size(); ++i)
    texture.push_back(weights[i] * (heights[i] - course[i]));
  return texture;
}

} // namespace patina
