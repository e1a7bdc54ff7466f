// Where in its period a place lies, exact however many periods it is away (A20).
#pragma once

#include <cmath>

namespace patina {

// Farther away, or not a number, there is no phase that a double could tell.
inline constexpr double kFarthestPhase = 0x1p52;

// 2 pi = kTurn + kTurnRest to 107 bits.
inline constexpr double kTurn = 6.283185307179586;
inline constexpr double kTurnRest = 2.4492935982947064e-16;

// x omega modulo 2 pi, in [-pi, pi] to rounding, as if product and quotient were of twice the
// digits: the error is 1e-15 rad at 1e9 periods. Never NaN: 0 beyond kFarthestPhase.
inline double exactPhase(double x, double omega) noexcept {
  const double product = x * omega;
  if (!(std::abs(product) < kFarthestPhase)) return 0;
  const double product_rest = std::fma(x, omega, -product);
  const double turns = std::nearbyint(product * (1 / kTurn));
  const double whole = turns * kTurn;
  const double whole_rest = std::fma(turns, kTurn, -whole);
  return (product - whole) + ((product_rest - whole_rest) - turns * kTurnRest);
}

} // namespace patina
