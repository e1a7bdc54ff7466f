// A plane of harmonics as a table of polynomials: a period is cut into square cells, each of which
// keeps the sum as a product of Chebyshev's series, in floats. The quickest form where six digits
// do.
#pragma once

#include <optional>
#include <vector>

#include "scene/fourier/exact_phase.h"
#include "scene/fourier/plane_value.h"

namespace patina {

class PlaneCells {
 public:
  // What floats leave of the rms, and the most that a table may weigh.
  static constexpr double kFinest = 2e-6;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  // `plane` as in FourierTexture, of which the mean is left out. As few cells as keep the errors'
  // root mean squares below a fifth of `value_error` and of `slope_error` (by the phase): the
  // errors of so many waves are hardly anywhere more than five times that. Nothing where that
  // weighs more than kMostBytes.
  static std::optional<PlaneCells> of(const std::vector<double>& plane, int harmonics, double omega,
                                      double value_error, double slope_error);

  PlaneValue at(double x, double y) const noexcept {
    return look_(ring_, cells_.data(), x, y);
  }                                                        // [m]
  PlaneValue atPlainly(double x, double y) const noexcept; // as a processor without AVX2 does
  std::size_t bytes() const { return sizeof(Cell) * cells_.size(); }

 private:
  // Powers of -1 .. 1 along x, of each those along y.
  struct alignas(64) Cell {
    float power[8][8];
  };

  PlaneValue (*look_)(const ExactRing& ring, const void* cells, double x,
                      double y) noexcept = nullptr;
  ExactRing ring_;
  std::vector<Cell> cells_; // rows along x
};

} // namespace patina
