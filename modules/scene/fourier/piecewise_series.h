// A Fourier series as a piecewise Taylor polynomial: each of equal cells of a period stores the
// derivatives at its centre, so that value and slope take one polynomial.
#pragma once

#include <vector>

#include "scene/fourier/reduced_phase.h"
#include "scene/fourier/series_sum.h"

namespace patina {

class PiecewiseSeries {
 public:
  // Keeps within `value_error` and `slope_error` (by the phase) of the series except for rounding;
  // the next derivative of all terms bounds Taylor's remainder. omega: phase per argument of at()
  // [rad/m].
  PiecewiseSeries(const FourierSeries& series, double value_error, double slope_error,
                  double omega);

  SeriesValue at(double x) const noexcept { // x as for PeriodicCells
    SeriesValue sum = kernel_(ring_, table_.data(), x);
    sum.slope *= slope_scale_;
    return sum;
  }
  // Returns a view; slopes by the phase.
  SeriesTable table() const noexcept { return {ring_, table_.data(), rows_, slope_scale_}; }
  std::size_t bytes() const { return sizeof(double) * table_.size(); }

 private:
  PeriodicCells ring_;
  SeriesKernel kernel_;
  int rows_ = 0;
  double slope_scale_ = 0;
  std::vector<double> table_; // cell after cell, each in rows of four (series_cells_kernel.h)
};

} // namespace patina
