#include "haptics/loop_model/stability_limit.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "haptics/loop_model/zoh_integrator.h"

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
TEST(StabilityLimit, MatchesTheClosedFormWithoutDelayAndVirtualDamping) {
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
    EXPECT_NEAR(stiffnessLimit(loop) / linearStabilityLimit(loop), 1, 1e-3) << delay;
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

TEST(StabilityLimit, SpectralRadiusPassesOneAtTheLimit) {
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

// Runs the loop tick by tick from a random state: its mean growth a tick over many.
double growth(const SampledLoop& loop, double stiffness, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const ZohStep held = zohStep({loop.mass, loop.damping, loop.hand_stiffness, 0}, loop.period);
  const double time = loop.cutoff ? 1 / (2 * std::numbers::pi * *loop.cutoff) : 0;
  double x = normal(random), last = normal(random), v = normal(random), filtered = normal(random);
  std::deque<double> under_way(static_cast<std::size_t>(loop.delay), normal(random));
  constexpr int kTicks = 40000;
  double logarithm = 0;
  for (int k = 0; k < kTicks; ++k) {
    filtered += loop.period / (time + loop.period) * ((x - last) / loop.period - filtered);
    under_way.push_back(-stiffness * x - loop.virtual_damping * filtered);
    const double force = under_way.front();
    under_way.pop_front();
    last = x;
    x = held.xx * last + held.xv * v + held.xf * force;
    v = held.vx * last + held.vv * v + held.vf * force;
    if (stiffness == 0 && loop.hand_stiffness == 0) { // the position then changes nothing
      last -= x;
      x = 0;
    }
    double size = std::abs(x) + std::abs(last) + loop.period * (std::abs(v) + std::abs(filtered));
    for (const double f : under_way) size += std::abs(f) * loop.period * loop.period / loop.mass;
    if (k >= kTicks / 2) logarithm += std::log(size);
    x /= size;
    last /= size;
    v /= size;
    filtered /= size;
    for (double& f : under_way) f /= size;
  }
  return std::exp(logarithm / (kTicks / 2));
}

TEST(StabilityLimit, SpectralRadiusIsTheGrowthOfTheLoop) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 60; ++round) {
    SampledLoop loop;
    loop.mass = 0.05 + unit(random);
    loop.damping = 3 * unit(random);
    loop.period = round % 2 ? 1e-3 : 2e-3;
    loop.delay = round % 4;
    loop.virtual_damping = unit(random) * loop.mass / loop.period;
    if (round % 3 == 0) loop.cutoff = 20 + 200 * unit(random);
    if (round % 5 > 1) loop.hand_stiffness = 1000 * unit(random);
    const double stiffness =
        round % 6 == 5 ? 0 : unit(random) * loop.mass / (loop.period * loop.period);
    EXPECT_NEAR(growth(loop, stiffness, random), spectralRadius(loop, stiffness), 1e-3) << round;
  }
}

// The damper's loop with two states has a closed form: v' = a v - e B v becomes unstable at -1.
TEST(StabilityLimit, DampingLimitIsNearTwoMassesATickAndFallsWithDelay) {
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

TEST(StabilityLimit, RisesWithAHand) {
  const DeviceModel device;
  const double alone = stiffnessLimit(sampledLoop(device));
  EXPECT_NEAR(stiffnessLimit(sampledLoop(device, {.2, 2, 0})), 5 * alone, 0.02 * 5 * alone);
}

TEST(StabilityLimit, RefusesInvalidLoops) {
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
