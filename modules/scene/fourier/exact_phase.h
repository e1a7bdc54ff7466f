// Where in its period a place lies, exact however many periods it is away (A20).
#pragma once

#include <cmath>
#include <cstdint>

#if defined(__GNUC__)
#define PATINA_ALWAYS_INLINE [[gnu::always_inline]] inline
#else
#define PATINA_ALWAYS_INLINE inline
#endif

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

struct RingPlace {
  int step = 0;      // from 0 on, fewer than all
  double beyond = 0; // its beginning, 0 .. 1 but for rounding
};

// A period cut into equal steps: in which a place lies, and where in it, as exact as the phase. One
// product and no quotient; without FMA the product's rest is that of halves (Dekker 1971).
class ExactRing {
 public:
  ExactRing() = default;
  ExactRing(double omega, int steps)
      : steps_(steps), mask_((steps & (steps - 1)) == 0 ? steps - 1 : 0), all_(steps),
        inverse_(1. / steps), per_metre_(omega * steps / kTurn) {
    const double product = omega * steps, rest = std::fma(omega, steps, -product);
    const double left = std::fma(-per_metre_, kTurn, product); // exact
    rest_ = (left + rest - per_metre_ * kTurnRest) / kTurn;
    const double split = kSplit * per_metre_;
    high_ = split - (split - per_metre_);
    low_ = per_metre_ - high_;
  }
  PATINA_ALWAYS_INLINE int steps() const { return steps_; }
  PATINA_ALWAYS_INLINE double stepsATurn() const { return all_; }

  // That of 0 where x is no number or kFarthestStep steps away.
  PATINA_ALWAYS_INLINE RingPlace at(double x) const noexcept {
    // Builtins alone: a kernel of another instruction set inlines this.
    if (!(__builtin_fabs(x * per_metre_) < kFarthestStep)) x = 0;
    const double product = x * per_metre_;
#if defined(__FMA__)
    const double rest = __builtin_fma(x, per_metre_, -product);
#else
    const double split = kSplit * x, high = split - (split - x), low = x - high;
    const double rest = ((high * high_ - product) + high * low_ + low * high_) + low * low_;
#endif
    const double whole = __builtin_floor(product);
    const double beyond = (product - whole) + (rest + x * rest_);
    if (mask_ > 0) return {static_cast<int>(static_cast<std::int64_t>(whole) & mask_), beyond};
    // The half keeps the quotient's rounding away from whole numbers.
    const double step = whole - all_ * __builtin_floor((whole + 0.5) * inverse_);
    return {static_cast<int>(step), beyond};
  }

 private:
  static constexpr double kSplit = 0x1p27 + 1, kFarthestStep = 0x1p50;

  int steps_ = 1;
  std::int64_t mask_ = 0;                                   // steps less one, of a power of two
  double all_ = 1, inverse_ = 1, per_metre_ = 0, rest_ = 0; // steps a metre, as the sum of two
  double high_ = 0, low_ = 0;                               // the first of them in halves
};

} // namespace patina
