#include "haptics/stability/stability_limit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace patina {
namespace {

// K* without delay, B and hand spring, in closed form (MATH 2.1.2).
double undelayedLimit(double mass, double damping, double period) {
  const double x = damping * period / mass;
  const double m_per_b2 = mass / (damping * damping), period2_per_m = period * period / mass;
  // For small x = b T/m the differences lose their digits; the second limit is then far away.
  if (x < 1e-3) return x * (1 - x / 2 + x * x / 6) / (period2_per_m * (0.5 - x / 3 + x * x / 8));
  const double a = std::exp(-x), loss = -std::expm1(-x);
  const double oscillating = loss / (m_per_b2 * (loss - a * x));
  const double alternating = 2 * (1 + a) / (m_per_b2 * (x * (1 + a) - 2 * loss));
  return std::min(oscillating, alternating);
}

// MATH 2.1.2, over the whole range of b T/m.
TEST(StabilityLimit, IsTheClosedFormWithoutDelayAndVirtualDamping) {
  for (const double mass : {.01, .1, 1.})
    for (const double share : {1e-6, 1e-4, 1e-3, .01, .1, .5, 1., 2., 5.}) {
      SampledLoop loop;
      loop.mass = mass;
      loop.damping = share * mass / loop.period;
      EXPECT_NEAR(stiffnessLimit(loop) / undelayedLimit(mass, loop.damping, loop.period), 1, 1e-5)
          << mass << " " << share;
    }
}

TEST(StabilityLimit, ApproachesTheRuleOfThumbForLittleDamping) {
  for (const int delay : {0, 1, 5, 20}) {
    SampledLoop loop;
    loop.damping = 1e-3;
    loop.virtual_damping = 2e-3;
    loop.delay = delay;
    EXPECT_NEAR(stiffnessLimit(loop) / ruleOfThumb(loop), 1, 1e-3) << delay;
  }
}

TEST(StabilityLimit, IsZeroWithoutAnyDampingAndWithTooMuch) {
  SampledLoop loop;
  loop.damping = 0;
  EXPECT_EQ(stiffnessLimit(loop), 0);
  loop.virtual_damping = 1;
  EXPECT_NEAR(stiffnessLimit(loop), 2000, 50);
  loop.virtual_damping = 1.01 * dampingLimit(loop);
  EXPECT_EQ(stiffnessLimit(loop), 0);
}

TEST(StabilityLimit, SpectralRadiusPassesOneThere) {
  for (const int delay : {0, 2, 7})
    for (const double damping : {0., 1.}) {
      SampledLoop loop;
      loop.delay = delay;
      loop.virtual_damping = damping;
      loop.hand_stiffness = 30;
      const double limit = stiffnessLimit(loop);
      EXPECT_LT(spectralRadius(loop, 0.999 * limit), 1);
      EXPECT_GT(spectralRadius(loop, 1.001 * limit), 1);
    }
}

// With two states the damper's loop has a closed form: v' = a v - e B v becomes unstable at -1.
TEST(StabilityLimit, OfVirtualDampingIsNearTwoMassesATickAndFallsWithDelay) {
  SampledLoop loop;
  double before = 1e9;
  for (const int delay : {0, 1, 2, 5, 20}) {
    loop.delay = delay;
    const double limit = dampingLimit(loop);
    if (delay == 0) {
      EXPECT_NEAR(limit, 200.7, 0.05);
    }
    EXPECT_LT(limit, 0.7 * before) << delay;
    before = limit;
  }
}

TEST(StabilityLimit, AHandHelps) {
  const DeviceModel device;
  const double alone = stiffnessLimit(sampledLoop(device));
  EXPECT_NEAR(stiffnessLimit(sampledLoop(device, {.2, 2, 0})), 5 * alone, 0.02 * 5 * alone);
}

TEST(StabilityLimit, RefusesWhatIsNoLoop) {
  SampledLoop loop;
  loop.mass = 0;
  EXPECT_THROW(stiffnessLimit(loop), std::invalid_argument);
  EXPECT_THROW(dampingLimit(loop), std::invalid_argument);
  loop = {};
  loop.delay = -1;
  EXPECT_THROW(spectralRadius(loop, 1), std::invalid_argument);
}

} // namespace
} // namespace patina
