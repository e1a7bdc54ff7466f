// A Fourier series and its slope at one phase, by different roads to the same digits (A19).
#pragma once

#include <vector>

#include "scene/fourier/fourier_texture.h"
#include "scene/fourier/series_value.h"

namespace patina {

// A sine and a cosine for every term.
SeriesValue sumDirectly(const FourierSeries& series, double phase);

// Coefficients of a series, laid out for sums by rotation: eight harmonics advance at a time, each
// turned by eight times the phase. The drift is that of N / 8 products.
class RotatedSeries {
 public:
  explicit RotatedSeries(const FourierSeries& series);
  SeriesValue at(double phase) const noexcept;
  std::size_t bytes() const { return sizeof(double) * (a_.size() + b_.size()); }

 private:
  double mean_ = 0;
  std::vector<double> a_, b_; // filled up with zeros to whole blocks
};

// u(phase) and du/dphase of a plane's terms: 1, cos, sin, cos 2, sin 2 ..., 2 N + 1 each.
void fillTerms(double phase, int harmonics, double* terms, double* slopes);

} // namespace patina
