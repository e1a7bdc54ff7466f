// A cell of a line's table at a place: compiled once for every instruction set, within the kernels
// that look into one. Nothing but what is always inlined.
#pragma once

#include "scene/fourier/series_value.h"

namespace patina::PATINA_KERNEL {

using Four = double __attribute__((vector_size(32)));
using Stored = double __attribute__((vector_size(32), aligned(8)));

// Coefficients in kRows rows of four: of t^k, t^(k + kRows), t^(k + 2 kRows), t^(k + 3 kRows), for
// k = 0 on. Four polynomials side by side: the chain of products is a quarter as long.
template <int kRows>
[[gnu::always_inline]] inline SeriesValue polynomial(const double* coefficients,
                                                     double t) noexcept {
  const Stored* row = reinterpret_cast<const Stored*>(coefficients);
  Four value = row[kRows - 1], slope = {0, 0, 0, 0};
  double before = 1; // t^(kRows - 1)
  for (int k = kRows - 2; k >= 0; --k) {
    slope = slope * t + value;
    value = value * t + Four(row[k]);
    before *= t;
  }
  const double power = before * t, square = power * power;
  const Four powers = {1, power, square, square * power};
  const Four slopes = Four{0, kRows, 2 * kRows, 3 * kRows} * before * Four{0, 1, power, square};
  slope = slope * powers + value * slopes;
  value = value * powers;
  return {(value[0] + value[1]) + (value[2] + value[3]),
          (slope[0] + slope[1]) + (slope[2] + slope[3])};
}

} // namespace patina::PATINA_KERNEL
