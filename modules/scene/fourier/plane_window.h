// A plane of harmonics as samples seen through a window: terms are divided by the window's own
// spectrum, summed on a grid of twice as many samples as terms, and a place is the weighted sum of
// the few samples around it (Potts, Steidl, Tasche 2001, with the window of Kaiser and Bessel).
#pragma once

#include <vector>

#include "scene/fourier/exact_phase.h"
#include "scene/fourier/plane_value.h"

namespace patina {

class PlaneWindow {
 public:
  // `plane` as in FourierTexture, of which the mean is left out. The window is the narrowest of 4,
  // 8, 12, 14 or 16 samples that keeps what other harmonics look like below `tolerance` of the sum
  // of all.
  PlaneWindow(const std::vector<double>& plane, int harmonics, double omega, double tolerance);

  PlaneValue at(double x, double y) const noexcept; // [m]
  std::size_t bytes() const { return sizeof(double) * (grid_.size() + weights_.size()); }

 private:
  template <int kWidth> PlaneValue through(double x, double y) const noexcept;

  int width_ = 0;
  ExactRing ring_; // of samples
  std::size_t stride_ = 0;
  std::vector<double> grid_;    // rows along x, repeated over its border by a window's width
  std::vector<double> weights_; // of each sample in the window, by -1 .. 1 over a step
};

} // namespace patina
