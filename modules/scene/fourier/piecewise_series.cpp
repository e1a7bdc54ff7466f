#include "scene/fourier/piecewise_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/processor.h"

#define PATINA_KERNEL series_plain
#include "scene/fourier/series_cells_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace series_avx2 {
SeriesKernel seriesKernel(int rows) noexcept; // series_cells_avx2.cpp
}
namespace {

constexpr std::array kCoefficients = {4, 8, 12, 16};
constexpr std::size_t kCachedCells = 6144; // coefficients that fit the cache
constexpr int kMinCells = 8;
constexpr int kMaxCells = 1 << 20; // enough for 16 coefficients at any error

struct CellLeft {
  double value = 0, slope = 0;
};

// Returns the truncation error of `count` coefficients in a cell of half width `half` [rad].
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
  int cells = kMinCells;
  for (; cells < kMaxCells; cells *= 2) {
    const CellLeft left = leftOut(series, std::numbers::pi / cells, count);
    if (left.value <= value_error && left.slope <= slope_error) break;
  }
  return cells;
}

SeriesKernel kernelOfThisProcessor(int rows) {
#if defined(__x86_64__)
  if (hasAvx2()) return series_avx2::seriesKernel(rows);
#endif
  return series_plain::seriesKernel(rows);
}

} // namespace

PiecewiseSeries::PiecewiseSeries(const FourierSeries& series, double value_error,
                                 double slope_error, double omega) {
  int cells = 0, degree = 0;
  for (const int count : kCoefficients) {
    const int due = cellsFor(series, value_error, slope_error, count);
    const auto size = static_cast<std::size_t>(due) * static_cast<std::size_t>(count);
    const bool first = cells == 0, smaller = size < table_.size();
    if (first || (table_.size() > kCachedCells && smaller)) {
      cells = due;
      degree = count;
      table_.resize(size);
    }
  }
  ring_ = PeriodicCells(omega, cells);
  rows_ = degree / 4;
  kernel_ = kernelOfThisProcessor(rows_);
  const double width = 2 * std::numbers::pi / cells, half = width / 2;
  slope_scale_ = 1 / half;
  std::vector<double> weight(series.a.size() * static_cast<std::size_t>(degree));
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    double w = 1;
    for (int k = 0; k < degree; ++k) {
      weight[i * static_cast<std::size_t>(degree) + static_cast<std::size_t>(k)] =
          k % 4 < 2 ? w : -w;
      w *= static_cast<double>(i + 1) * half / (k + 1);
    }
  }
  for (int cell = 0; cell < cells; ++cell) {
    double* c = table_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(degree);
    std::fill(c, c + degree, 0.0);
    const double middle = (cell + 0.5) * width;
    for (std::size_t i = 0; i < series.a.size(); ++i) {
      const double angle = static_cast<double>(i + 1) * middle;
      const double co = std::cos(angle), si = std::sin(angle);
      const double even = series.a[i] * co + series.b[i] * si;
      const double odd = series.b[i] * co - series.a[i] * si;
      const double* w = weight.data() + i * static_cast<std::size_t>(degree);
      for (int k = 0; k < degree; k += 2) {
        c[4 * (k % rows_) + k / rows_] += w[k] * even;
        c[4 * ((k + 1) % rows_) + (k + 1) / rows_] += w[k + 1] * odd;
      }
    }
    c[0] += series.mean;
  }
}

} // namespace patina
