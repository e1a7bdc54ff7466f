// The simulated hand yields to the surface, and a scene that asks for it gets it.
#include "app/gui/servo/hand_device.h"

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

Vec3 restUnder(const Vec3& force, const Vec3& target) {
  const auto hand = makeHandDevice(Vec3::Zero());
  hand->setTarget(target);
  Vec3 tip;
  for (int tick = 0; tick < 3000; ++tick) tip = hand->exchange(force, 1e-3);
  return tip;
}

TEST(HandDevice, RestsWhereItsSpringBearsTheForce) {
  const HandSpec spec;
  const Vec3 force(0.5, -1, 0.25), target(0.01, 0, 0.02);
  EXPECT_LT((restUnder(force, target) - (target + force / spec.stiffness)).norm(), 1e-9);
}

TEST(HandDevice, NeverPullsHarderThanItMay) {
  const HandSpec spec;
  const auto hand = makeHandDevice(Vec3::Zero(), spec);
  hand->setTarget(Vec3(1, 0, 0));
  // Held still by a wall that gives way to more than the hand's most.
  for (int tick = 0; tick < 2000; ++tick)
    ASSERT_LT(hand->exchange(Vec3(-1.001 * spec.max_force, 0, 0), 1e-3)[0], 1e-9);
}

TEST(HandDevice, AForceArrivesAfterTheDelayOfTheModel) {
  HandSpec spec;
  spec.device.delay = 3;
  const auto hand = makeHandDevice(Vec3::Zero(), spec);
  for (int tick = 0; tick < 3; ++tick)
    EXPECT_EQ(hand->exchange(Vec3(1, 0, 0), 1e-3), Vec3::Zero()) << tick;
  EXPECT_GT(hand->exchange(Vec3(1, 0, 0), 1e-3)[0], 0);
}

TEST(HandDevice, TheTipIsReadInWholeStepsOfTheEncoder) {
  HandSpec spec;
  spec.device.encoder_step = 50e-6;
  const auto hand = makeHandDevice(Vec3::Zero(), spec);
  hand->setTarget(Vec3(0.01, -0.004, 0));
  for (int tick = 0; tick < 500; ++tick) {
    const Vec3 counts = hand->exchange(Vec3::Zero(), 1e-3) / spec.device.encoder_step;
    ASSERT_LT((counts - counts.array().round().matrix()).norm(), 1e-9);
  }
}

TEST(HandDevice, DryFrictionHoldsAgainstAnyForceUpToItsOwn) {
  HandSpec spec;
  spec.device.coulomb = 0.4;
  const auto held = makeHandDevice(Vec3::Zero(), spec);
  for (int tick = 0; tick < 200; ++tick)
    ASSERT_EQ(held->exchange(Vec3(0.24, 0.31, 0), 1e-3), Vec3::Zero()); // 0.392 N
  // Past it the tip goes to where the hand's spring bears the rest.
  const auto moved = makeHandDevice(Vec3::Zero(), spec);
  Vec3 tip;
  for (int tick = 0; tick < 3000; ++tick) tip = moved->exchange(Vec3(1, 0, 0), 1e-3);
  EXPECT_NEAR(tip[0], (1 - 0.4) / spec.stiffness, 1e-6);
}

using SimulatedHand = WindowTest;

TEST_F(SimulatedHand, BalancesTheSurfaceInASceneThatAsksForIt) {
  constexpr double kRadius = 0.03;
  Scene scene = sceneOf(icosphere(kRadius, 30), "sphere");
  scene.device = "simulated";
  saveWorkspace(scene, folder_ / "ws");
  ASSERT_TRUE(open(folder_ / "ws"));
  send(QEvent::MouseButtonDblClick, middle(), Qt::LeftButton, Qt::LeftButton);
  turnWheel(3);
  wait(700);
  const ToolSample sample = window_->lastSample();
  ASSERT_TRUE(sample.contact);
  const Vec3 pull = HandSpec{}.stiffness * (view().target() - sample.tip);
  ASSERT_LT(pull.norm(), HandSpec{}.max_force);
  EXPECT_GT(pull.norm(), 0.1);
  EXPECT_LT((pull + sample.force).norm(), 0.05 * pull.norm()); // the mouse's tip would have no pull
}

} // namespace
} // namespace patina
