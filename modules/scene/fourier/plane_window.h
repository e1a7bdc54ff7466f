// A plane of harmonics as samples seen through a window: terms are divided by the window's own
// spectrum, summed on a grid of twice as many samples as terms, and a place is the weighted sum of
// the few samples around it (Potts, Steidl, Tasche 2001, with the window of Kaiser and Bessel).
#pragma once

#include <vector>

#include "scene/fourier/fourier_texture.h"

namespace patina {

// Value and slopes by the phases.
struct PlaneValue {
  double value = 0, slope_x = 0, slope_y = 0;
};

class PlaneWindow {
 public:
  // `plane` as in FourierTexture, of which the mean is left out. The window is the narrowest of 4,
  // 8, 12 or 16 samples that keeps what other harmonics look like below `tolerance` of the sum of
  // all.
  PlaneWindow(const std::vector<double>& plane, int harmonics, double tolerance);

  PlaneValue at(double x, double y) const noexcept; // phases in [-pi, pi]
  std::size_t bytes() const { return sizeof(double) * (grid_.size() + weights_.size()); }

 private:
  template <int kWidth> PlaneValue through(double x, double y) const noexcept;

  int width_ = 0, samples_ = 0;
  double samples_per_turn_ = 0; // by the phase
  std::size_t stride_ = 0;
  std::vector<double> grid_;    // rows along x, repeated over its border by a window's width
  std::vector<double> weights_; // of each sample in the window, by -1 .. 1 over a step
};

} // namespace patina
