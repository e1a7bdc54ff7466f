// Position of a point in its period, exact at any number of periods (A20).
#pragma once

#include <cmath>
#include <cstdint>

#if defined(__GNUC__)
#define PATINA_ALWAYS_INLINE [[gnu::always_inline]] inline
#else
#define PATINA_ALWAYS_INLINE inline
#endif

namespace patina {

// The largest phase that a double can resolve.
inline constexpr double kMaxPhase = 0x1p52;

// 2 pi = kTwoPiHigh + kTwoPiLow to 107 bits.
inline constexpr double kTwoPiHigh = 6.283185307179586;
inline constexpr double kTwoPiLow = 2.4492935982947064e-16;

// Returns x omega modulo 2 pi, in [-pi, pi] up to rounding, by argument reduction in double-double
// arithmetic (Dekker 1971): the error is 1e-15 rad at 1e9 periods. Never NaN: 0 beyond
// kMaxPhase.
inline double reducePhase(double x, double omega) noexcept {
  const double product = x * omega;
  if (!(std::abs(product) < kMaxPhase)) return 0;
  const double product_rest = std::fma(x, omega, -product);
  const double turns = std::nearbyint(product * (1 / kTwoPiHigh));
  const double whole = turns * kTwoPiHigh;
  const double whole_rest = std::fma(turns, kTwoPiHigh, -whole);
  return (product - whole) + ((product_rest - whole_rest) - turns * kTwoPiLow);
}

struct CellPosition {
  int step = 0;        // 0 or more, less than the number of steps
  double fraction = 0; // position in the cell, 0 .. 1 except for rounding
};

// A period divided into equal cells: finds a point's cell and its position there, as exactly as the
// phase, by one product and no division; without FMA the product is split into halves.
class PeriodicCells {
 public:
  PeriodicCells() = default;
  PeriodicCells(double omega, int steps)
      : steps_(steps), mask_((steps & (steps - 1)) == 0 ? steps - 1 : 0), all_(steps),
        inverse_(1. / steps), per_metre_(omega * steps / kTwoPiHigh) {
    const double product = omega * steps, rest = std::fma(omega, steps, -product);
    const double left = std::fma(-per_metre_, kTwoPiHigh, product); // exact
    rest_ = (left + rest - per_metre_ * kTwoPiLow) / kTwoPiHigh;
    const double split = kSplit * per_metre_;
    high_ = split - (split - per_metre_);
    low_ = per_metre_ - high_;
  }
  PATINA_ALWAYS_INLINE int steps() const { return steps_; }

  // Returns the position of 0 if x is NaN or kMaxStep steps away.
  PATINA_ALWAYS_INLINE CellPosition at(double x) const noexcept {
    // Builtins only: kernels of other instruction sets inline this.
    if (!(__builtin_fabs(x * per_metre_) < kMaxStep)) x = 0;
    const double product = x * per_metre_;
#if defined(__FMA__)
    const double rest = __builtin_fma(x, per_metre_, -product);
#else
    const double split = kSplit * x, high = split - (split - x), low = x - high;
    const double rest = ((high * high_ - product) + high * low_ + low * high_) + low * low_;
#endif
    const double whole = __builtin_floor(product);
    const double fraction = (product - whole) + (rest + x * rest_);
    if (mask_ > 0) return {static_cast<int>(static_cast<std::int64_t>(whole) & mask_), fraction};
    // The half keeps the rounded quotient away from integers.
    const double step = whole - all_ * __builtin_floor((whole + 0.5) * inverse_);
    return {static_cast<int>(step), fraction};
  }

 private:
  static constexpr double kSplit = 0x1p27 + 1, kMaxStep = 0x1p50;

  int steps_ = 1;
  std::int64_t mask_ = 0;                                   // steps - 1 for a power of two
  double all_ = 1, inverse_ = 1, per_metre_ = 0, rest_ = 0; // steps per metre, as the sum of two
  double high_ = 0, low_ = 0;                               // halves of the first
};

} // namespace patina
