// The safety nets in the closed loop (F13, MATH 2.3).
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/contact_fixture.h"
#include "haptics/law/coupling_stage.h"
#include "stability/loop_support.h"

namespace patina {
namespace {

constexpr double kWallStiffnesses[] = {900, 3000, 1e4, 1e5, 1e6, 1e7};
const Stabilisers kPassivity{false, true};

SimulationSpec pressed(double speed, int delay = 0) {
  SimulationSpec spec;
  spec.press = 1;
  spec.speed = speed;
  spec.device.delay = delay;
  return spec;
}

// T-SAFE and T-VC1, with the coupling at its planned stiffness.
TEST(StabilisedLoop, RestsAtAnyStiffnessAndDisplaysTheSeriesFormula) {
  for (const double stiffness : kWallStiffnesses)
    for (const int delay : {0, 1, 2})
      for (const double speed : {0., .2}) {
        const SimulationSpec spec = pressed(speed, delay);
        const Wall wall{.stiffness = stiffness, .stabilisers = std::nullopt};
        const SimulationReport run = runOn(wall, spec);
        const StabiliserPlan plan =
            planStabilisers(propertiesOf(wall), spec.device, wall.stabilisers);
        ASSERT_TRUE(plan.coupling);
        const auto [coupling, damping, most] = *plan.coupling;
        EXPECT_GE(most, damping);
        EXPECT_LT(run.rms_velocity, 1e-9) << stiffness << " " << delay << " " << speed;
        EXPECT_TRUE(run.stable);
        const double series = stiffness * coupling / (stiffness + coupling);
        EXPECT_NEAR(run.stiffness_displayed.value_or(0) / series, 1, 1e-3);
        EXPECT_GE(coupling, 0.4 * (.5 + damping) / (5e-4 + delay * 1e-3));
        EXPECT_EQ(run.fault_ticks, 0u);
      }
}

// The stabilisers never make the loop worse on any device, and where they act the tip comes to
// rest: with an encoder within one step a tick.
TEST(StabilisedLoop, IsNeverWorseThanThePlainLoopOnAnyDevice) {
  for (const double mass : {.02, .1, .5})
    for (const double damping : {0., .5, 5.})
      for (const double rate : {500., 1000., 4000.})
        for (const int delay : {0, 2, 5})
          for (const double step : {0., 20e-6})
            for (const double stiffness : {600., 1e5}) {
              SimulationSpec spec = pressed(.2, delay);
              spec.device = {mass, damping, 0, step, rate, delay};
              const SimulationReport plain = runOn({.stiffness = stiffness}, spec);
              const SimulationReport safe =
                  runOn({.stiffness = stiffness, .stabilisers = std::nullopt}, spec);
              const std::string what = "m " + std::to_string(mass) + " b " +
                                       std::to_string(damping) + " rate " + std::to_string(rate) +
                                       " n " + std::to_string(delay) + " step " +
                                       std::to_string(step) + " K " + std::to_string(stiffness);
              EXPECT_LE(safe.rms_velocity, 1.05 * plain.rms_velocity + 1e-9) << what;
              if (step == 0) {
                EXPECT_TRUE(safe.stable) << what;
              }
            }
}

// T-PC1; a loop that rings shows the need for the controller.
TEST(StabilisedLoop, PassivityControllerQuietensUpToTenTimesTheLimit) {
  for (const double stiffness : {3000., 1e4}) {
    const SimulationReport run =
        runOn({.stiffness = stiffness, .stabilisers = kPassivity}, pressed(.2));
    EXPECT_LT(run.rms_velocity, 5e-3) << stiffness;
    EXPECT_NEAR(run.stiffness_displayed.value_or(0) / stiffness, 1, 0.01);
    const SimulationReport plain = runOn({.stiffness = stiffness}, pressed(.2));
    EXPECT_GT(plain.rms_velocity, 0.15);
    EXPECT_FALSE(plain.stable);
  }
}

// T-TRAP, the negative control: limiting the rate of the force destabilises.
TEST(StabilisedLoop, NaiveLimiterIsWorseThanNothing) {
  SimulationSpec spec = pressed(.2);
  const double plain = runOn({.stiffness = 3000}, spec).rms_velocity;
  spec.rate_limit = 2 * spec.device.damping * spec.device.rate;
  const SimulationReport naive = runOn({.stiffness = 3000}, spec);
  EXPECT_GE(naive.rms_velocity, 3 * plain);
  EXPECT_FALSE(naive.stable);
}

// MATH 2.3 without stabiliser and with damping alone, as docs/studies.md lists them [m/s, 8th
// second].
TEST(StabilisedLoop, PlainAndDampedWallsFollowTheTable) {
  EXPECT_NEAR(runOn({.stiffness = 900}, pressed(.2)).rms_velocity, 2.0e-2, 4e-3);
  EXPECT_NEAR(runOn({.stiffness = 3000}, pressed(.2)).rms_velocity, .21, .02);
  EXPECT_NEAR(runOn({.stiffness = 1e4}, pressed(.2)).rms_velocity, .40, .03);
  for (const double stiffness : {900., 3000.})
    for (const double damping : {2., 5.})
      EXPECT_LT(runOn({.stiffness = stiffness, .damping = damping}, pressed(.2)).rms_velocity,
                1e-9);
  EXPECT_NEAR(runOn({.stiffness = 1e4, .damping = 2}, pressed(.2)).rms_velocity, .25, .03);
  EXPECT_LT(runOn({.stiffness = 1e4, .damping = 5}, pressed(.2)).rms_velocity, 5e-5);
}

// T-SAT: the device's own limit scales the vector.
TEST(StabilisedLoop, SaturationBoundsForceAndMotionAndKeepsTheDirection) {
  SimulationSpec spec = pressed(.2);
  spec.saturation = 3.3;
  double deepest = 0, farthest = 0, largest = 0;
  runOn({.stiffness = 1e4}, spec, [&](const SimulationRow& row) {
    largest = std::max(largest, row.force.norm());
    deepest = std::min(deepest, row.position.z());
    farthest = std::max(farthest, row.position.z());
  });
  EXPECT_LE(largest, 3.3);
  EXPECT_GT(largest, 3.29);
  EXPECT_GT(deepest, -0.02);
  EXPECT_LT(farthest, 0.2);

  const Vec3 wanted(6, -3, 2);
  Progress progress;
  simulate(
      [&](const Vec3&, double) {
        return LawOutput{wanted, false, false, 0};
      },
      spec, progress,
      [&](const SimulationRow& row) {
        EXPECT_NEAR(row.force.normalized().dot(wanted.normalized()), 1, 1e-12);
      });
}

// MATH 2.6: in stick the wall is a spring along the surface too; damping along the normal alone
// would leave it ringing.
SimulationReport stopsWhileStuck(double stiffness, bool stabilised) {
  Scene scene = withFriction(sceneOf(stiffness), 5, 5);
  if (stabilised) scene.device_model = DeviceModel{};
  const auto snapshot = compileStages(scene, planeField(0x1p-11, 64));
  ContactMemory memory;
  constexpr double kPress = 4;
  const double depth =
      kPress *
      (1 / stiffness +
       (stabilised ? 1 / snapshot->stabilisers.coupling.value_or(CouplingPlan{1}).stiffness : 0));
  const ForceLaw law = [&](const Vec3& tip, double dt) {
    const Contact contact = tick(*snapshot, memory, tip, dt);
    return LawOutput{contact.force - Vec3(0, 0, kPress), contact.touching, contact.fault,
                     contact.depth};
  };
  SimulationSpec spec;
  spec.surface = Vec3(0, 0, -depth);
  spec.inward = Vec3::UnitX();
  spec.speed = 0.02;
  spec.seconds = 16;
  Progress progress;
  return simulate(law, spec, progress);
}

TEST(StabilisedLoop, SticksQuietlyBelowTheLimitAlongTheSurface) {
  EXPECT_LT(stopsWhileStuck(500, false).rms_velocity, 1e-5);
  EXPECT_TRUE(stopsWhileStuck(500, false).stable);
  EXPECT_FALSE(stopsWhileStuck(1100, false).stable);
}

TEST(StabilisedLoop, CouplingQuietensStick) {
  for (const double stiffness : {1100., 1e4, 1e5})
    EXPECT_LT(stopsWhileStuck(stiffness, true).rms_velocity, 1e-9) << stiffness;
}

// An absent plan is an absent stage and bitwise the same force.
TEST(StabilisedLoop, CostsNothingInASafeScene) {
  Scene plain = sceneOf(400), safe = sceneOf(400);
  safe.device_model = DeviceModel{};
  const Field field = planeField();
  const auto without = compileStages(plain, field), with = compileStages(safe, field);
  ASSERT_EQ(without->stages.size(), with->stages.size());
  EXPECT_FALSE(with->stabilisers.coupling || with->stabilisers.passivity);
  ContactMemory a, b;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 tip(1e-4 * std::sin(0.01 * i), 0, 1e-3 * std::sin(0.02 * i));
    EXPECT_EQ(tick(*without, a, tip, 1e-3).force, tick(*with, b, tip, 1e-3).force);
  }
}

// The whole pipeline on a curved surface, through compileStages.
TEST(StabilisedLoop, RestsOnASphere) {
  Scene scene = sceneOf(1e5);
  scene.device_model = DeviceModel{};
  const auto snapshot = compileStages(scene, sphereField());
  ASSERT_TRUE(snapshot->stabilisers.coupling);
  SimulationSpec spec = pressed(.2);
  spec.surface = Vec3(0, 0, .03);
  Progress progress;
  const SimulationReport run = simulate(*snapshot, spec, progress);
  EXPECT_LT(run.rms_velocity, 1e-9);
  EXPECT_NEAR(run.stiffness_displayed.value_or(0),
              inSeries(1e5, snapshot->stabilisers.coupling->stiffness), 5);
}

// A tip that nearly fills a bowl: R is its centre's range. Its walls are nearly one, and K d / (R +
// d) along them exceeds what the device alone damps.
TEST(StabilisedLoop, RestsInABowlHardlyWiderThanTheTip) {
  double worst = 0;
  for (const double room : {0.2e-3, 0.5e-3, 1e-3})
    for (const double stiffness : {2000.0, 1e5, 1e7}) {
      const double tip = 1e-3;
      Scene scene = sceneOf(stiffness);
      scene.device_model = DeviceModel{};
      scene.haptics.tip_radius = tip;
      const auto snapshot = compileStages(
          scene, cubeField([=](const Vec3& p) { return room + tip - p.norm(); }, 0.05e-3, 96, 30));
      SimulationSpec spec;
      spec.surface = Vec3(1e-5, 2e-5, 0);
      spec.press = 1;
      spec.seconds = 16;
      Progress progress;
      const SimulationReport run = simulate(*snapshot, spec, progress);
      EXPECT_LE(run.rms_velocity, 1e-5) << room << " " << stiffness;
      EXPECT_EQ(run.fault_ticks, 0u);
      EXPECT_LT(run.max_depth, 4e-3);
      worst = std::max(worst, run.rms_velocity);
    }
  std::printf("narrow bowl: at rest to %.2g m/s\n", worst);
}

} // namespace
} // namespace patina
