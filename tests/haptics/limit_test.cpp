#include "haptics/contact_fixture.h"
#include "haptics/law/limit_stage.h"
#include "support/constants.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

using test::kPeriod;

std::shared_ptr<const HapticSnapshot> plane(double stiffness = 500, double limit = 3.3) {
  Scene scene = sceneOf(stiffness);
  scene.haptics.force_limit = limit;
  return compileStages(scene, planeField());
}

// The vector is scaled: its direction is that of the unlimited force.
TEST(ForceLimit, KeepsTheDirection) {
  const Field sphere = sphereField();
  Scene scene = withFriction(sceneOf(2000), 0.6, 0.6);
  const auto free = compileStages(scene, sphere);
  scene.haptics.force_limit = 3.3;
  const auto limited = compileStages(scene, sphere);
  ContactMemory a, b;
  tick(*free, a, Vec3(0, 0, 0.0302), kPeriod);
  tick(*limited, b, Vec3(0, 0, 0.0302), kPeriod);
  bool was_limited = false;
  for (double angle = 0; angle < 0.6; angle += 0.002) {
    const Vec3 tip = (0.03 - 0.006 * angle) * Vec3(std::sin(angle), 0, std::cos(angle));
    const Vec3 whole = tick(*free, a, tip, kPeriod).force;
    const Vec3 scaled = tick(*limited, b, tip, kPeriod).force;
    EXPECT_LE(scaled.norm(), 3.3);
    EXPECT_NEAR(scaled.norm(), std::min(3.3, whole.norm()), 1e-12);
    if (whole.norm() > 0) {
      EXPECT_LT(scaled.normalized().cross(whole.normalized()).norm(), 1e-12);
    }
    was_limited |= whole.norm() > 3.3;
  }
  EXPECT_TRUE(was_limited);
}

// F13: the rate is never limited. An entry at 2 m/s has its full force in every tick.
TEST(JumpFault, FastEntryIsNoFault) {
  for (const double speed : {0.1, 1.0, 2.0, 3.5}) {
    const auto snapshot = plane(500, 100);
    ContactMemory memory;
    const double step = speed * kPeriod;
    for (double z = 2.5 * step; z > -12e-3; z -= step) {
      const Contact contact = tick(*snapshot, memory, Vec3(0, 0, z), kPeriod);
      EXPECT_FALSE(contact.fault);
      EXPECT_NEAR(contact.force.z(), std::max(0.0, -500 * z), 1e-5) << speed;
    }
  }
}

TEST(JumpFault, FastEntryWithDampingIsNoFault) {
  Scene scene = sceneOf(500);
  scene.haptics.damping = 5;
  const auto snapshot = compileStages(scene, planeField());
  ContactMemory memory;
  for (double z = 0.01; z > -12e-3; z -= 2e-3) {
    EXPECT_FALSE(tick(*snapshot, memory, Vec3(0, 0, z), kPeriod).fault);
  }
}

// The onset of slip drops the force by (mu_s - mu_d) K d in one tick: friction, not a fault.
TEST(JumpFault, BreakingLooseIsNoFault) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 1.0, 0.05), planeField());
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 1e-4));
  glide(*snapshot, memory, Vec3(0, 0, -8e-3));
  double largest = 0;
  Vec3 last = memory.limit.last->force;
  for (double x = 0; x < 12e-3; x += 0.1e-3) {
    const Contact contact = tick(*snapshot, memory, Vec3(x, 0, -8e-3), kPeriod);
    EXPECT_FALSE(contact.fault);
    largest = std::max(largest, (contact.force - last).norm());
    last = contact.force;
  }
  EXPECT_GT(largest, 2 * kHandSpeed * 500 * kPeriod); // above the fault's limit without slip
}

// A teleport of 50 mm into contact: no force at first, then the contact's force fades in.
TEST(JumpFault, TeleportIntoContactFadesIn) {
  const auto snapshot = plane();
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 10e-3), kPeriod);
  Contact contact;
  double last = 0;
  for (int i = 1; i <= 300; ++i) {
    contact = tick(*snapshot, memory, Vec3(12e-3, 0, -12e-3), kPeriod);
    EXPECT_TRUE(contact.touching);
    EXPECT_EQ(contact.fault, (i - 0.5) * kPeriod < kFaultFadeTime + kFaultReturnTime) << i;
    EXPECT_LE(contact.force.norm(), i * kPeriod < kFaultFadeTime - 1e-9 ? 0 : 3.3);
    EXPECT_GE(contact.force.z(), last);
    EXPECT_LT(contact.force.z() - last, 0.04);
    last = contact.force.z();
  }
  EXPECT_NEAR(last, 3.3, 1e-9); // the limit
}

// A teleport out of contact: the last force fades over the stated time, monotonically.
TEST(JumpFault, TeleportOutOfContactFadesTheLastForce) {
  const auto snapshot = plane();
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
  const Vec3 pressed = glide(*snapshot, memory, Vec3(0, 0, -6e-3)).force;
  EXPECT_NEAR(pressed.z(), 3.0, 1e-6);
  double last = pressed.z();
  for (int i = 1; i <= 60; ++i) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, 14e-3), kPeriod);
    EXPECT_NEAR(contact.force.z(), pressed.z() * std::max(0.0, 1 - i * kPeriod / kFaultFadeTime),
                1e-9);
    EXPECT_LE(contact.force.z(), last);
    last = contact.force.z();
  }
  EXPECT_FALSE(memory.limit.fault);
}

// MATH 2.8: one missed 20 ms tick while pressing in at 0.3 m/s is no fault by itself.
TEST(JumpFault, MissedTickIsNoFault) {
  const auto snapshot = plane(500, 100);
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
  glide(*snapshot, memory, Vec3(0, 0, -1e-3), 0.3e-3);
  Contact contact = tick(*snapshot, memory, Vec3(0, 0, -7e-3), 20e-3);
  EXPECT_FALSE(contact.fault);
  EXPECT_NEAR(contact.force.z(), 3.5, 1e-5);
  contact = tick(*snapshot, memory, Vec3(0, 0, -7.3e-3), kPeriod);
  EXPECT_FALSE(contact.fault);
  // The same step within one period is a fault.
  memory.reset();
  tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
  glide(*snapshot, memory, Vec3(0, 0, -1e-3), 0.3e-3);
  EXPECT_TRUE(tick(*snapshot, memory, Vec3(0, 0, -7e-3), kPeriod).fault);
}

// v_max grows with a model that is larger than the hand's workspace.
TEST(JumpFault, SpeedScalesWithTheModel) {
  for (const double radius : {0.05, 10.0}) {
    const Field sphere = sphereField(radius, 100);
    Scene scene = sceneOf(50 / radius);
    const auto snapshot = compileStages(scene, sphere);
    ContactMemory memory;
    for (double r = 1.02; r > 0.95; r -= 0.001) {
      EXPECT_FALSE(tick(*snapshot, memory, Vec3(0, 0, r * radius), kPeriod).fault) << radius;
    }
  }
}

// At the default K the scaled speed alone would allow 10 N a tick, three times the limit.
TEST(JumpFault, FiresOnAModelOfAMetre) {
  Scene scene = sceneOf(500);
  scene.haptics.force_limit = 3.3;
  const auto snapshot = compileStages(scene, planeField(0x1p-6)); // 1 m
  for (const double depth : {8e-3, 50e-3}) {
    ContactMemory memory;
    tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, -depth), kPeriod);
    EXPECT_TRUE(contact.fault) << depth;
    EXPECT_EQ(contact.force, Vec3::Zero().eval());
  }
  // 3 m/s is faster than a hand and yet no fault.
  ContactMemory memory;
  for (double z = 3e-3; z > -50e-3; z -= 3e-3) {
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, z), kPeriod);
    EXPECT_FALSE(contact.fault) << z;
    EXPECT_NEAR(contact.force.z(), std::clamp(-500 * z, 0.0, 3.3), 1e-4) << z;
  }
}

TEST(JumpFault, NonFiniteForceIsAFault) {
  const LimitStage stage{LimitSpec{}};
  ContactMemory memory;
  Contact contact;
  contact.dt = kPeriod;
  contact.touching = true;
  contact.force = Vec3(0, std::nan(""), 0);
  stage.apply(contact, memory);
  EXPECT_TRUE(contact.fault);
  EXPECT_EQ(contact.force, Vec3::Zero().eval());
}

} // namespace
} // namespace patina
