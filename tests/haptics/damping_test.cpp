#include <numbers>

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"

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

TEST(Damping, SeesTheBackwardDifference) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  ContactMemory memory;
  for (int i = 0; i < 3; ++i) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, 2e-4 * i), 1e-3);
    EXPECT_NEAR(contact.velocity.z(), i ? 0.2 : 0, 1e-12);
  }
}

TEST(Damping, ACutoffFiltersTheVelocityThatItSees) {
  Scene scene = sceneOf(500);
  scene.haptics.damping = 1;
  scene.haptics.damping_cutoff = 200;
  const auto snapshot = compileStages(scene, planeField());
  ContactMemory memory;
  Contact contact;
  for (int i = 0; i < 50; ++i) contact = tick(*snapshot, memory, Vec3(0, 0, 2e-4 * i), 1e-3);
  EXPECT_NEAR(contact.velocity.z(), 0.2, 1e-12);
  // The first tick of a step passes dt / (dt + 1 / (2 pi 200)).
  contact = tick(*snapshot, memory, memory.last_tip, 1e-3);
  EXPECT_NEAR(contact.velocity.z() / 0.2, 1 - 1 / (1 + 1 / (0.4 * std::numbers::pi)), 1e-9);
}

} // namespace
} // namespace patina
