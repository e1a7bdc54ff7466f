// The stability limit of the simulated loop, against eigenvalues and closed form (F3, MATH 2.1).
#include <gtest/gtest.h>

#include <cmath>

#include "stability/loop_support.h"

namespace patina {
namespace {

SimulationSpec specOf(double mass, double damping, int delay = 0, double rate = 1000) {
  SimulationSpec spec;
  spec.device.mass = mass;
  spec.device.damping = damping;
  spec.device.delay = delay;
  spec.device.rate = rate;
  return spec;
}

double limitOf(const SimulationSpec& spec, const Wall& wall) {
  return stiffnessLimit(sceneLoop(propertiesOf(wall), spec.device, spec.hand));
}

void expectMeasured(const SimulationSpec& spec, const Wall& wall, double tolerance) {
  const double exact = limitOf(spec, wall);
  const double measured = measuredLimit(wall, spec, 0.5 * exact, 1.5 * exact);
  EXPECT_NEAR(measured / exact, 1, tolerance)
      << "m " << spec.device.mass << " b " << spec.device.damping << " n " << spec.device.delay
      << " B " << wall.damping << " rate " << spec.device.rate;
}

// MATH 2.1.2.
TEST(SimulatedWall, IsStableUpToTheEigenvalueLimitWithoutDelay) {
  const struct {
    double mass, damping, limit;
  } table[] = {{.05, .5, 1001.7}, {.1, .1, 200.03}, {.1, .5, 1000.83},
               {.1, 5, 10084},    {.1, 50, 109050}, {.2, 1, 2001.7}};
  for (const auto& [mass, damping, limit] : table) {
    const SimulationSpec spec = specOf(mass, damping);
    EXPECT_NEAR(limitOf(spec, {}) / limit, 1, 1e-4);
    expectMeasured(spec, {}, 0.003);
  }
}

// MATH 2.1.3 over delays and virtual damping.
TEST(SimulatedWall, IsStableUpToTheEigenvalueLimitWithDelayAndVirtualDamping) {
  const struct {
    int delay;
    double limit[5];
  } table[] = {{0, {1000.8, 1991.7, 2972.7, 4905, 10474}},
               {1, {333.8, 663.9, 990, 1632, 3468}},
               {2, {200.4, 398.1, 592.9, 974, 2049}},
               {5, {91.3, 180.5, 267.5, 435, 881}}};
  const double damping[5] = {0, .5, 1, 2, 5};
  for (const auto& [delay, limit] : table)
    for (int i = 0; i < 5; ++i) {
      const Wall wall{.damping = damping[i]};
      const SimulationSpec spec = specOf(.1, .5, delay);
      EXPECT_NEAR(limitOf(spec, wall) / limit[i], 1, 1e-3) << delay << " " << damping[i];
      expectMeasured(spec, wall, 0.003);
    }
  for (const int delay : {3, 4}) expectMeasured(specOf(.1, .5, delay), {.damping = 2}, 0.003);
}

// F3: the rule of thumb.
TEST(SimulatedWall, IsStableUpToAFewPerCentOfTheRuleOfThumb) {
  for (const int delay : {0, 1, 2})
    for (const double damping : {0., .5, 1., 2.}) {
      const Wall wall{.damping = damping};
      const SimulationSpec spec = specOf(.1, .5, delay);
      const double rule = linearStabilityLimit(sceneLoop(propertiesOf(wall), spec.device));
      EXPECT_NEAR(limitOf(spec, wall) / rule, 1, 0.03);
    }
}

TEST(SimulatedWall, IsStableUpToTheEigenvalueLimitAtOtherRatesAndWithAHand) {
  for (const double rate : {250., 4000., 10000.})
    expectMeasured(specOf(.1, .5, 1, rate), {}, 0.003);
  SimulationSpec held = specOf(.05, .1);
  held.hand = {.15, .8, 120};
  expectMeasured(held, {}, 0.003);
  expectMeasured(held, {.damping = 1}, 0.003);
}

// MATH 2.1.4: a filter is a delay of the damping.
TEST(SimulatedWall, LimitFallsWithTheCutoffOfTheVelocity) {
  double before = limitOf(specOf(.1, .5), {.damping = 2});
  for (const double cutoff : {2000., 500., 200., 100.}) {
    const Wall wall{.damping = 2, .cutoff = cutoff};
    const double limit = limitOf(specOf(.1, .5), wall);
    EXPECT_LT(limit, before) << cutoff;
    expectMeasured(specOf(.1, .5), wall, 0.003);
    before = limit;
  }
}

// MATH 2.1.3: virtual damping alone buzzes from about 2m/T on.
TEST(SimulatedWall, DampingAloneBuzzesAboveItsOwnLimit) {
  for (const double mass : {.05, .1, .2}) {
    const double limit = dampingLimit(sampledLoop(specOf(mass, .5).device));
    EXPECT_NEAR(limit, 2 * mass / 1e-3 + .7, .1);
    for (const double share : {0.97, 1.03}) {
      // The wall's condition F.n >= 0 is left out, so that the damper acts alone.
      double last = 0;
      const ForceLaw damper = [&](const Vec3& tip, double dt) {
        const double velocity = (tip.z() - last) / dt;
        last = tip.z();
        return LawOutput{Vec3(0, 0, -share * limit * velocity), false, false, 0};
      };
      SimulationSpec spec = specOf(mass, .5);
      spec.speed = 1e-6;
      Progress progress;
      const SimulationReport run = simulate(damper, spec, progress);
      EXPECT_EQ(run.rms_velocity < run.rms_early || run.rms_early == 0, share < 1)
          << mass << " " << share;
    }
  }
}

// The verdict of `patina simulate`, a per cent to either side.
TEST(SimulatedWall, VerdictTurnsAtTheLimit) {
  SimulationSpec spec = specOf(.1, .5);
  spec.press = 1;
  EXPECT_TRUE(runOn({.stiffness = 0.99 * 1000.83}, spec).stable);
  EXPECT_FALSE(runOn({.stiffness = 1.01 * 1000.83}, spec).stable);
}

// 2.3: a force held from sample to sample does exactly F.dx; nothing else moves the tip here.
TEST(SimulatedWall, LedgerIsTheLossOfKineticEnergy) {
  SimulationSpec spec = specOf(.1, 0);
  spec.speed = .2;
  spec.depth = -1e-3;
  SimulationRow last;
  const SimulationReport run =
      runOn({.stiffness = 700}, spec, [&](const SimulationRow& row) { last = row; });
  const double kinetic = 0.5 * .1 * (.2 * .2 - last.velocity.squaredNorm());
  EXPECT_NEAR(last.energy, kinetic, 1e-12);
  EXPECT_LT(run.energy.absorbed, 0) << "a sampled spring gives energy";
  EXPECT_DOUBLE_EQ(run.energy.absorbed_with_damping, run.energy.absorbed) << "no damping to credit";
}

// 2.3: in the safe region only the surface gives energy, and the device's damping dissipates it.
TEST(SimulatedWall, CreditedLedgerStaysPositiveWhereTheLoopIsStable) {
  SimulationSpec spec = specOf(.1, .5);
  spec.speed = .2;
  spec.press = 1;
  const SimulationReport safe = runOn({.stiffness = 900}, spec);
  EXPECT_LT(safe.energy.lowest_absorbed, -5e-3);
  EXPECT_GT(safe.energy.lowest_absorbed_with_damping, -1e-12);
  EXPECT_LT(runOn({.stiffness = 3000}, spec).energy.lowest_absorbed_with_damping, -1e-4);
}

} // namespace
} // namespace patina
