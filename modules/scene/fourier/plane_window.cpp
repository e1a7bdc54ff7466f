#include "scene/fourier/plane_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/fourier/series_sum.h"

namespace patina {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr int kSamplesPerHarmonic = 4;
constexpr int kFewestSamples = 16;

// Coefficients of a weight's polynomial for a window so wide.
constexpr int coefficientsOf(int width) {
  return width + 4;
}

struct Window {
  int width;
  double beta = 0.98 * std::numbers::pi * width * (1 - 0.5 / (kSamplesPerHarmonic / 2.0));

  long double at(long double z) const { // samples from its middle
    const long double inside = 1 - 4 * z * z / (width * width);
    return std::cyl_bessel_i(0.0L, beta * std::sqrt(std::max(0.0L, inside)));
  }
  // Its spectrum at a frequency in radians a sample.
  double spectrum(double frequency) const {
    const double reach = frequency * width / 2, square = beta * beta - reach * reach;
    const double root = std::sqrt(std::abs(square));
    if (root < 1e-8) return width;
    return width * (square > 0 ? std::sinh(root) : std::sin(root)) / root;
  }
};

// The most that a harmonic's nearest likeness, a turn of the grid away, adds to its slope.
double likeness(const Window& window, int harmonics, int samples) {
  double most = 0;
  for (int j = 1; j <= harmonics; ++j) {
    const double step = 2 * std::numbers::pi / samples, own = window.spectrum(j * step);
    for (const int beside : {samples - j, samples + j})
      // The bound of its waves, not where they cross zero.
      most = std::max(
          most, window.width /
                    (own * std::sqrt(std::max(1.0, std::pow(beside * step * window.width / 2, 2) -
                                                       window.beta * window.beta))) *
                    beside / harmonics);
  }
  return most;
}

// Polynomials by t = -1 .. 1 through Chebyshev's points: rows are powers, columns samples. Their
// slopes show the rounding of the points a hundredfold.
Rows weightsOf(const Window& window) {
  const int count = coefficientsOf(window.width);
  Rows weights(count, window.width);
  for (int k = 0; k < window.width; ++k) {
    Long chebyshev = Long::Zero(count);
    for (int i = 0; i < count; ++i) {
      const long double angle = std::numbers::pi_v<long double> * (i + 0.5L) / count;
      const long double z = (std::cos(angle) + 1) / 2 + window.width / 2 - 1 - k;
      for (int d = 0; d < count; ++d)
        chebyshev[d] += (d == 0 ? 1.0L : 2.0L) / count * window.at(z) * std::cos(d * angle);
    }
    Long before = Long::Zero(count), now = before, sum = before;
    now[0] = 1; // T0, of which T1 = t T0
    for (int d = 0; d < count; ++d) {
      sum += chebyshev[d] * now;
      Long next = -before;
      next.tail(count - 1) += (d == 0 ? 1.0L : 2.0L) * now.head(count - 1);
      before = now;
      now = next;
    }
    weights.col(k) = sum.cast<double>();
  }
  return weights;
}

template <int kWidth> struct Weights {
  alignas(32) std::array<double, kWidth> value, slope;

  Weights(const double* coefficients, double t) noexcept {
    constexpr int kCount = coefficientsOf(kWidth);
    const double* c = coefficients + (kCount - 1) * kWidth;
    for (int k = 0; k < kWidth; ++k) {
      value[static_cast<std::size_t>(k)] = c[k];
      slope[static_cast<std::size_t>(k)] = 0;
    }
    for (int d = kCount - 2; d >= 0; --d) {
      c -= kWidth;
      for (std::size_t k = 0; k < kWidth; ++k) {
        slope[k] = slope[k] * t + value[k];
        value[k] = value[k] * t + c[k];
      }
    }
  }
};

} // namespace

PlaneWindow::PlaneWindow(const std::vector<double>& plane, int harmonics, double omega,
                         double tolerance)
    : ring_(omega, std::max(kFewestSamples, kSamplesPerHarmonic * harmonics)) {
  const int samples = ring_.steps();
  for (const int width : {4, 8, 12, 14, 16}) {
    width_ = width;
    if (likeness({width}, harmonics, samples) <= tolerance) break;
  }
  const Window window{width_};
  const Rows weights = weightsOf(window);
  weights_.assign(weights.data(), weights.data() + weights.size());

  const int side = 2 * harmonics + 1;
  Rows terms(samples, side), slopes(1, side);
  for (int i = 0; i < samples; ++i)
    fillTerms(2 * std::numbers::pi * i / samples, harmonics, terms.row(i).data(), slopes.data());
  Eigen::VectorXd divided(side);
  for (int r = 0; r < side; ++r)
    divided[r] = 1 / window.spectrum((r + 1) / 2 * 2 * std::numbers::pi / samples);
  terms *= divided.asDiagonal();
  Rows coefficients = Eigen::Map<const Rows>(plane.data(), side, side);
  coefficients(0, 0) = 0;
  const Rows grid = terms * coefficients * terms.transpose();

  const int around = samples + width_;
  stride_ = static_cast<std::size_t>(around);
  grid_.resize(stride_ * stride_);
  const int before = width_ / 2 - 1;
  for (int r = 0; r < around; ++r)
    for (int c = 0; c < around; ++c)
      grid_[static_cast<std::size_t>(r) * stride_ + static_cast<std::size_t>(c)] =
          grid((r - before + samples) % samples, (c - before + samples) % samples);
}

template <int kWidth> PlaneValue PlaneWindow::through(double x, double y) const noexcept {
  const RingPlace column = ring_.at(x), row = ring_.at(y);
  const Weights<kWidth> along_x(weights_.data(), 2 * column.beyond - 1),
      along_y(weights_.data(), 2 * row.beyond - 1);
  alignas(32) std::array<double, kWidth> value{}, slope{};
  const double* samples = grid_.data() + static_cast<std::size_t>(row.step) * stride_ +
                          static_cast<std::size_t>(column.step);
  for (std::size_t r = 0; r < kWidth; ++r, samples += stride_)
    for (std::size_t k = 0; k < kWidth; ++k) {
      value[k] += along_y.value[r] * samples[k];
      slope[k] += along_y.slope[r] * samples[k];
    }
  PlaneValue sum;
  for (std::size_t k = 0; k < kWidth; ++k) {
    sum.value += along_x.value[k] * value[k];
    sum.slope_x += along_x.slope[k] * value[k];
    sum.slope_y += along_x.value[k] * slope[k];
  }
  const double by_phase = ring_.steps() / std::numbers::pi;
  sum.slope_x *= by_phase;
  sum.slope_y *= by_phase;
  return sum;
}

PlaneValue PlaneWindow::at(double x, double y) const noexcept {
  switch (width_) {
  case 4:
    return through<4>(x, y);
  case 8:
    return through<8>(x, y);
  case 12:
    return through<12>(x, y);
  case 14:
    return through<14>(x, y);
  default:
    return through<16>(x, y);
  }
}

} // namespace patina
