// Polynomial of one cell of a line's table, compiled within the kernels of each instruction set.
// Uses always inlined functions only.
#pragma once

#include "field/store/four.h"
#include "scene/fourier/series_value.h"

namespace patina::PATINA_KERNEL {

// Coefficients in kRows rows of four: of t^k, t^(k + kRows), t^(k + 2 kRows), t^(k + 3 kRows), for
// k = 0 .. kRows - 1. Four parallel polynomials shorten the chain of products to a quarter.
template <int kRows>
[[gnu::always_inline]] inline SeriesValue polynomial(const double* coefficients,
                                                     double t) noexcept {
  const Double4At* row = reinterpret_cast<const Double4At*>(coefficients);
  Double4 value = row[kRows - 1], slope = {0, 0, 0, 0};
  double before = 1; // t^(kRows - 1)
  for (int k = kRows - 2; k >= 0; --k) {
    slope = slope * t + value;
    value = value * t + Double4(row[k]);
    before *= t;
  }
  const double power = before * t, square = power * power;
  const Double4 powers = {1, power, square, square * power};
  const Double4 slopes =
      Double4{0, kRows, 2 * kRows, 3 * kRows} * before * Double4{0, 1, power, square};
  slope = slope * powers + value * slopes;
  value = value * powers;
  return {(value[0] + value[1]) + (value[2] + value[3]),
          (slope[0] + slope[1]) + (slope[2] + slope[3])};
}

} // namespace patina::PATINA_KERNEL
