// The friction list of MATH 2.8, each case with its expected behaviour.
#include <gtest/gtest.h>

#include <numbers>

#include "haptics/contact_fixture.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPeriod;

ContactMemory pressedMemory(const HapticSnapshot& snapshot, double depth) {
  ContactMemory memory;
  tick(snapshot, memory, Vec3(0, 0, 1e-4), kPeriod);
  glide(snapshot, memory, Vec3(0, 0, -depth));
  return memory;
}

// mu = 10: sticks within 10 d, so that the force is a spring to the point of contact.
TEST(FrictionExtremes, VeryRoughSurfaceIsASpring) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 10, 10), planeField());
  ContactMemory memory = pressedMemory(*snapshot, 1e-3);
  for (double x = 0; x < 14e-3; x += 0.05e-3) {
    const Contact contact = tick(*snapshot, memory, Vec3(x, 0, -1e-3), kPeriod);
    EXPECT_NEAR(contact.force.x(), -500 * std::min(x, 10e-3), 1e-5);
    EXPECT_NEAR(contact.force.z(), 0.5, 1e-6);
  }
}

// 2.4: no step if the coefficient grows; K (|p - c| - mu_d d) if it shrinks below the held force.
TEST(FrictionExtremes, StepOfTheCoefficientWhileStuck) {
  const Field plane = planeField();
  const auto rough = compileStages(withFriction(sceneOf(500), 0.5, 0.5), plane);
  const auto rougher = compileStages(withFriction(sceneOf(500), 0.9, 0.9), plane);
  const auto smooth = compileStages(withFriction(sceneOf(500), 0.2, 0.1), plane);
  const double d = 2e-3;
  ContactMemory memory = pressedMemory(*rough, d);
  const Vec3 tip(0.8e-3, 0, -d);
  const Vec3 held = glide(*rough, memory, tip).force;
  EXPECT_NEAR(held.x(), -0.4, 1e-6);
  EXPECT_EQ(tick(*rougher, memory, tip, kPeriod).force, held);
  const Contact let_go = tick(*smooth, memory, tip, kPeriod);
  EXPECT_NEAR(let_go.force.x(), -0.1 * 500 * d, 1e-6);
  EXPECT_FALSE(let_go.fault);
}

// Reversal at 100 Hz: the loop's energy is still the closed form of T-K09b.
TEST(FrictionExtremes, ReversalAt100HzDissipatesTheClosedForm) {
  const double K = 500, mu = 0.4, d = 1e-3, amplitude = 2e-3;
  const auto snapshot = compileStages(withFriction(sceneOf(K), mu, mu), planeField());
  ContactMemory memory = pressedMemory(*snapshot, d);
  double energy = 0, last_force = 0, last_x = 0;
  const int cycle = 100; // at 10 kHz
  for (int i = 0; i <= 20 * cycle; ++i) {
    const double x = amplitude * std::sin(2 * std::numbers::pi * i / cycle);
    const double force = tick(*snapshot, memory, Vec3(x, 0, -d), 1e-4).force.x();
    if (i > 10 * cycle) energy -= 0.5 * (force + last_force) * (x - last_x);
    last_force = force;
    last_x = x;
  }
  const double expected = 4 * mu * K * d * (amplitude - mu * d);
  EXPECT_NEAR(energy / 10, expected, 0.02 * expected);
}

TEST(FrictionExtremes, DepthOfANanometre) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), planeField());
  ContactMemory memory = pressedMemory(*snapshot, 1e-9);
  for (double x = 0; x < 1e-3; x += 1e-5) {
    const Contact contact = tick(*snapshot, memory, Vec3(x, 0, -1e-9), kPeriod);
    EXPECT_TRUE(contact.force.allFinite());
    EXPECT_LE(contact.force.norm(), 500 * 1e-9 * 1.2);
  }
}

// The tip moves to the edge of a box and on past it, 1 mm deep: the contact point stays on the face
// where it is until the tip has left through the other, up to the share of friction, and without a
// fault.
TEST(FrictionExtremes, SlidesOverACrease) {
  const Vec3 half(8e-3, 8e-3, 8e-3);
  const Field box = cubeField([&](const Vec3& p) { return boxDistance(p, half); }, 0.25e-3, 96);
  for (const auto slip : {Friction::SlipDirection::paper, Friction::SlipDirection::displacement}) {
    Scene scene = withFriction(sceneOf(500), 0.5, 0.3);
    scene.haptics.friction->slip = slip;
    const auto snapshot = compileStages(scene, box);
    ContactMemory memory;
    glide(*snapshot, memory, Vec3(0, 0, 8.5e-3));
    const double d = 1e-3;
    glide(*snapshot, memory, Vec3(0, 0, 8e-3 - d));
    for (double x = 0; x < 10e-3; x += 0.05e-3) {
      const Contact contact = tick(*snapshot, memory, Vec3(x, 0, 8e-3 - d), kPeriod);
      EXPECT_FALSE(contact.fault) << x;
      EXPECT_LE(contact.force.norm(), 1.2 * 500 * d) << x;
      if (x < 7e-3) {
        EXPECT_GT(contact.normal.z(), 0.99) << x;
      }
    }
    EXPECT_FALSE(memory.contact.c);
    // On the side: plain Coulomb again.
    const Contact side = glide(*snapshot, memory, Vec3(8e-3 - d, 0, 2e-3), 0.05e-3);
    ASSERT_TRUE(side.touching);
    const Contact last = glide(*snapshot, memory, Vec3(8e-3 - d, 0, -2e-3), 0.05e-3);
    EXPECT_NEAR(last.force.x(), 500 * d, 1e-3);
    EXPECT_NEAR(last.force.z(), 0.3 * 500 * d, 2e-3);
  }
}

// Off the rim of a plate: the force ends, the stuck point is forgotten, and no state remains.
TEST(FrictionExtremes, SlidesOffAnEdge) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), plateField(2e-3));
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 1.2e-3));
  glide(*snapshot, memory, Vec3(0, 0, 0.8e-3));
  Contact contact;
  for (double x = 0; x < 3.6e-3; x += 0.02e-3) {
    contact = tick(*snapshot, memory, Vec3(x, 0, 0.8e-3), kPeriod);
    EXPECT_FALSE(contact.fault) << x;
    EXPECT_LE(contact.force.norm(), 0.2) << x;
  }
  EXPECT_FALSE(contact.touching);
  EXPECT_FALSE(memory.friction.stick);
}

} // namespace
} // namespace patina
