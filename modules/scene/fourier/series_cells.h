// A Fourier series as a table of polynomials: a period is cut into equal cells, each of which keeps
// the series' own derivatives at its middle, so that value and slope cost one polynomial.
#pragma once

#include <vector>

#include "scene/fourier/exact_phase.h"
#include "scene/fourier/series_sum.h"

namespace patina {

class SeriesCells {
 public:
  // Within `value_error` and `slope_error` (by the phase) of the series but for rounding: what
  // Taylor's polynomial leaves out is bounded by the next derivative of all terms. omega: of the
  // phase, by what at() is asked [rad/m].
  SeriesCells(const FourierSeries& series, double value_error, double slope_error, double omega);

  SeriesValue at(double x) const noexcept { // x as of ExactRing
    SeriesValue sum = look_(ring_, table_.data(), x);
    sum.slope *= slope_scale_;
    return sum;
  }
  // A view; slopes by the phase.
  SeriesTable table() const noexcept { return {ring_, table_.data(), rows_, slope_scale_}; }
  std::size_t bytes() const { return sizeof(double) * table_.size(); }

 private:
  ExactRing ring_;
  SeriesLook look_;
  int rows_ = 0;
  double slope_scale_ = 0;
  std::vector<double> table_; // cell upon cell, each in rows of four (series_cells_kernel.h)
};

} // namespace patina
