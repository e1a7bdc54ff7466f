#include <numbers>

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/law/spring_stage.h"

namespace patina {
namespace {

// T-K08: leaving at 0.5 m/s, the surface never pulls.
TEST(Damping, NeverPulls) {
  Scene scene = sceneOf(200);
  scene.haptics.damping = 5;
  const auto snapshot = compileStages(scene, planeField());
  ContactMemory memory;
  Contact contact = glide(*snapshot, memory, Vec3(0, 0, 1e-3));
  contact = glide(*snapshot, memory, Vec3(0, 0, -3e-3));
  EXPECT_GT(contact.force.z(), 200 * 3e-3); // pushing in, the damper adds
  bool clamped = false;
  for (double z = -3e-3; z < 0; z += 0.5e-3) {
    contact = tick(*snapshot, memory, Vec3(0, 0, z), 1e-3);
    EXPECT_GE(contact.force.dot(contact.normal), -1e-14);
    clamped |= contact.touching && contact.force.norm() < 1e-15;
  }
  EXPECT_TRUE(clamped); // 5 N s/m at 0.5 m/s outweighs 0.6 N: without the clamp it would pull
}

// T-K08b.
TEST(Damping, DoesNotChangeTheStaticForce) {
  Scene damped = sceneOf(500);
  damped.haptics.damping = 3;
  const auto with = compileStages(damped, sphereField());
  const auto without = compileStages(sceneOf(500), sphereField());
  ContactMemory a, b;
  const Vec3 tip(0.01, 0.02, 0.018);
  Contact first, second;
  for (int i = 0; i < 200; ++i) {
    first = tick(*with, a, tip, 1e-3);
    second = tick(*without, b, tip, 1e-3);
  }
  EXPECT_EQ(first.force, second.force);
}

// The walls only push, and some are nearly parallel: the damper is at most B |v|, never acts with
// the motion, and pulls on no wall.
TEST(Damping, IsBoundedDissipativeAndPushOnlyAtSeveralWalls) {
  const double damping = 2, stiffness = 500;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    Contact contact;
    contact.touching = true;
    contact.stiffness = stiffness;
    contact.velocity = 0.2 * randomDirection(random);
    contact.walls = 1 + i % 3;
    const double spread = std::pow(10.0, -3 * unit(random));
    const Vec3 middle = randomDirection(random);
    Vec3 way = Vec3::Zero(); // from tip to contact point
    for (int k = 0; k < contact.walls; ++k) {
      const Vec3 normal = (middle + spread * randomDirection(random)).normalized();
      contact.wall[static_cast<std::size_t>(k)] = {normal, 2e-3 * unit(random)};
      way += contact.wall[static_cast<std::size_t>(k)].multiplier * normal;
    }
    contact.normal = way.normalized();
    const Vec3 spring = contact.force = stiffness * way;
    dampConstrainedMotion(contact, damping, false);
    const Vec3 damper = contact.force - spring;
    ASSERT_LE(damper.norm(), damping * 0.2 * (1 + 1e-6)) << i;
    ASSERT_LE(damper.dot(contact.velocity), 1e-9) << i;
    // The force neither hinders nor attracts a motion that enters no wall.
    for (int k = 0; k < 20; ++k) {
      const Vec3 free = randomDirection(random);
      bool goes = true;
      for (int w = 0; w < contact.walls; ++w)
        goes = goes && contact.wall[static_cast<std::size_t>(w)].normal.dot(free) >= 0;
      if (goes) {
        ASSERT_GE(contact.force.dot(free), -1e-6) << i;
      }
    }
  }
}

// Each of two walls at right angles has its own share.
TEST(Damping, DampsEachWallOfACornerSeparately) {
  Contact contact;
  contact.touching = true;
  contact.stiffness = 500;
  contact.velocity = Vec3(-0.1, 0.3, 0.5);
  contact.walls = 2;
  contact.wall[0] = {Vec3::UnitX(), 2e-3};
  contact.wall[1] = {Vec3::UnitZ(), 1e-3};
  contact.normal = Vec3(2, 0, 1).normalized();
  contact.force = Vec3(1, 0, 0.5);
  dampConstrainedMotion(contact, 2, false);
  EXPECT_LT((contact.force - Vec3(1.2, 0, 0)).norm(), 1e-12); // it leaves the floor too fast
}

TEST(Damping, UsesTheBackwardDifference) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  ContactMemory memory;
  for (int i = 0; i < 3; ++i) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, 2e-4 * i), 1e-3);
    EXPECT_NEAR(contact.velocity.z(), i ? 0.2 : 0, 1e-12);
  }
}

TEST(Damping, CutoffFiltersItsVelocity) {
  Scene scene = sceneOf(500);
  scene.haptics.damping = 1;
  scene.haptics.damping_cutoff = 200;
  const auto snapshot = compileStages(scene, planeField());
  ContactMemory memory;
  Contact contact;
  for (int i = 0; i < 50; ++i) contact = tick(*snapshot, memory, Vec3(0, 0, 2e-4 * i), 1e-3);
  EXPECT_NEAR(contact.velocity.z(), 0.2, 1e-12);
  // The first tick of a step passes dt / (dt + 1 / (2 pi 200)).
  contact = tick(*snapshot, memory, *memory.tip.last, 1e-3);
  EXPECT_NEAR(contact.velocity.z() / 0.2, 1 - 1 / (1 + 1 / (0.4 * std::numbers::pi)), 1e-9);
}

} // namespace
} // namespace patina
