#include "scene/fourier/series_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace patina {
namespace {

constexpr std::array kCoefficients = {4, 8, 12, 16};
constexpr std::size_t kCachedCells = 6144; // coefficients that stay near the core
constexpr int kFewestCells = 8;
constexpr int kMostCells = 1 << 20; // never with 16 coefficients, whatever the error

struct CellLeft {
  double value = 0, slope = 0;
};

// What `count` coefficients leave out of a cell that reaches `half` phase to either side.
CellLeft leftOut(const FourierSeries& series, double half, int count) {
  CellLeft left;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const double j = static_cast<double>(i + 1);
    const double of_slope = std::hypot(series.a[i], series.b[i]) * j *
                            std::exp((count - 1) * std::log(j * half) - std::lgamma(count));
    left.slope += of_slope;
    left.value += of_slope * half / count;
  }
  return left;
}

int cellsFor(const FourierSeries& series, double value_error, double slope_error, int count) {
  int cells = kFewestCells;
  for (; cells < kMostCells; cells *= 2) {
    const CellLeft left = leftOut(series, std::numbers::pi / cells, count);
    if (left.value <= value_error && left.slope <= slope_error) break;
  }
  return cells;
}

template <int kCount> SeriesValue polynomial(const double* c, double t) noexcept {
  static_assert(kCount % 4 == 0);
  // Quarters side by side: the chain of products that wait for one another is a quarter as long.
  constexpr int kQuarter = kCount / 4;
  double value[4], slope[4];
  for (int q = 0; q < 4; ++q) {
    double v = 0, s = 0;
    for (int k = kQuarter - 1; k >= 0; --k) {
      s = s * t + v;
      v = v * t + c[q * kQuarter + k];
    }
    value[q] = v;
    slope[q] = s;
  }
  double power = t, power_slope = 1; // t^kQuarter and its slope
  for (int k = 1; k < kQuarter; ++k) {
    power_slope = power * (k + 1);
    power *= t;
  }
  SeriesValue sum{value[3], slope[3]};
  for (int q = 2; q >= 0; --q) {
    sum.slope = slope[q] + sum.slope * power + sum.value * power_slope;
    sum.value = value[q] + sum.value * power;
  }
  return sum;
}

} // namespace

SeriesCells::SeriesCells(const FourierSeries& series, double value_error, double slope_error) {
  int cells = 0;
  for (const int count : kCoefficients) {
    const int due = cellsFor(series, value_error, slope_error, count);
    const auto size = static_cast<std::size_t>(due) * static_cast<std::size_t>(count);
    const bool first = cells == 0, smaller = size < table_.size();
    if (first || (table_.size() > kCachedCells && smaller)) {
      cells = due;
      degree_ = count;
      table_.resize(size);
    }
  }
  last_ = cells - 1;
  width_ = 2 * std::numbers::pi / cells;
  cells_per_turn_ = 1 / width_;
  const double half = width_ / 2;
  slope_scale_ = 1 / half;
  std::vector<double> weight(series.a.size() * static_cast<std::size_t>(degree_));
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    double w = 1;
    for (int k = 0; k < degree_; ++k) {
      weight[i * static_cast<std::size_t>(degree_) + static_cast<std::size_t>(k)] =
          k % 4 < 2 ? w : -w;
      w *= static_cast<double>(i + 1) * half / (k + 1);
    }
  }
  for (int cell = 0; cell < cells; ++cell) {
    double* c = table_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(degree_);
    std::fill(c, c + degree_, 0.0);
    const double middle = (cell + 0.5) * width_;
    for (std::size_t i = 0; i < series.a.size(); ++i) {
      const double angle = static_cast<double>(i + 1) * middle;
      const double co = std::cos(angle), si = std::sin(angle);
      const double even = series.a[i] * co + series.b[i] * si;
      const double odd = series.b[i] * co - series.a[i] * si;
      const double* w = weight.data() + i * static_cast<std::size_t>(degree_);
      for (int k = 0; k < degree_; k += 2) {
        c[k] += w[k] * even;
        c[k + 1] += w[k + 1] * odd;
      }
    }
    c[0] += series.mean;
  }
}

SeriesValue SeriesCells::at(double phase) const noexcept {
  const double turn = phase < 0 ? phase + 2 * std::numbers::pi : phase;
  const int cell = std::clamp(static_cast<int>(turn * cells_per_turn_), 0, last_);
  return at(RingPlace{cell, (turn - cell * width_) * cells_per_turn_});
}

SeriesValue SeriesCells::at(const RingPlace& place) const noexcept {
  const double* c = table_.data() + static_cast<std::size_t>(place.step * degree_);
  const double t = 2 * place.beyond - 1;
  SeriesValue sum;
  switch (degree_) {
  case 4:
    sum = polynomial<4>(c, t);
    break;
  case 8:
    sum = polynomial<8>(c, t);
    break;
  case 12:
    sum = polynomial<12>(c, t);
    break;
  default:
    sum = polynomial<16>(c, t);
  }
  sum.slope *= slope_scale_;
  return sum;
}

} // namespace patina
