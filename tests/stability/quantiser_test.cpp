// Encoder steps against dry friction: chatter begins at K = 2 fc / Delta (F5, T-Q1).
#include <gtest/gtest.h>

#include "stability/loop_support.h"

namespace patina {
namespace {

constexpr double kStep = 30e-6;

// Pressed midway between the forces of two encoder steps.
SimulationReport pressedMidway(double stiffness, double friction, double damping, double speed) {
  SimulationSpec spec;
  spec.device.damping = damping;
  spec.device.coulomb = friction;
  spec.device.encoder_step = kStep;
  constexpr double kLevel = 20.5;
  spec.press = kLevel * stiffness * kStep;
  spec.depth = speed > 0 ? -1e-3 : kLevel * kStep;
  spec.speed = speed;
  return runOn({.stiffness = stiffness}, spec);
}

TEST(Quantiser, RestsBelowItsLimitAndChattersAboveIt) {
  for (const double friction : {0.02, 0.05})
    for (const double damping : {0.05, 5.0}) { // 2b/T = 100 and 10000 N/m
      const double limit = 2 * friction / kStep;
      EXPECT_EQ(pressedMidway(0.98 * limit, friction, damping, 0).rms_velocity, 0)
          << friction << " " << damping;
      EXPECT_GT(pressedMidway(1.02 * limit, friction, damping, 0).rms_velocity, 1e-6)
          << friction << " " << damping;
    }
}

// An impact with surplus damping ends the same way.
TEST(Quantiser, ComesToRestFromAnImpactBelowItsLimit) {
  for (const double friction : {0.02, 0.05}) {
    const double limit = 2 * friction / kStep;
    EXPECT_EQ(pressedMidway(0.98 * limit, friction, 5, 0.2).rms_velocity, 0) << friction;
    EXPECT_GT(pressedMidway(1.02 * limit, friction, 5, 0.2).rms_velocity, 1e-6) << friction;
  }
}

// 2.2: stable far above 2b/T from a quiet start only: dry friction locks a vibration that an impact
// would excite.
TEST(Quantiser, FrictionLocksAWallThatAnImpactWouldExcite) {
  EXPECT_EQ(pressedMidway(1200, 0.02, 0.05, 0).rms_velocity, 0);
  EXPECT_GT(pressedMidway(1200, 0.02, 0.05, 0.2).rms_velocity, 1e-2);
}

TEST(Quantiser, ReadsTheNearestStepOnEveryAxis) {
  SimulationSpec spec;
  spec.device.encoder_step = kStep;
  spec.speed = 0.01;
  spec.surface = Vec3(0.3, -0.2, 0.1);
  std::vector<Vec3> read;
  std::vector<Vec3> true_positions;
  Progress progress;
  simulate(
      [&](const Vec3& tip, double) {
        read.push_back(tip);
        return LawOutput{Vec3(0.01, 0.02, 0), false, false, 0};
      },
      spec, progress, [&](const SimulationRow& row) { true_positions.push_back(row.position); });
  for (std::size_t i = 0; i < read.size(); i += 7) {
    const Vec3 steps = (read[i] - spec.surface) / kStep;
    EXPECT_LT((steps - steps.array().round().matrix()).norm(), 1e-6);
    EXPECT_LE((read[i] - true_positions[i]).cwiseAbs().maxCoeff(), 0.5 * kStep * (1 + 1e-6));
  }
}

// 2.2: the noise of a backward difference of rounded positions, B step/T per count, is silent at
// rest.
TEST(Quantiser, DampingIsSilentAtRest) {
  SimulationSpec spec;
  spec.device.coulomb = 0.05;
  spec.device.encoder_step = kStep;
  spec.press = 1;
  spec.speed = 0.1;
  EXPECT_EQ(runOn({.stiffness = 1000, .damping = 2}, spec).rms_velocity, 0);
}

} // namespace
} // namespace patina
