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
  // Taylor's polynomial leaves out is bounded by the next derivative of all terms.
  SeriesCells(const FourierSeries& series, double value_error, double slope_error);

  SeriesValue at(double phase) const noexcept;           // in [-pi, pi]
  SeriesValue at(const RingPlace& place) const noexcept; // of a ring of as many steps
  int cells() const { return last_ + 1; }
  std::size_t bytes() const { return sizeof(double) * table_.size(); }

 private:
  int degree_ = 0; // its coefficients' count
  double cells_per_turn_ = 0, width_ = 0, slope_scale_ = 0;
  int last_ = 0;
  std::vector<double> table_; // cell upon cell, lowest coefficient first, by -1 .. 1 over the cell
};

} // namespace patina
