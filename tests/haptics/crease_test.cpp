#include <gtest/gtest.h>

#include "haptics/contact/pull_back.h"
#include "haptics/contact_fixture.h"
#include "haptics/law/proxy_stage.h"

namespace patina {
namespace {

// The tip is pressed 2.5 to 5 mm deep and slid across the bisector of a box's edge, at 7 um a tick,
// mostly deeper than the band: the contact point stays on its face, however near the other one is.
TEST(Crease, SlideAcrossAnEdgeBeyondTheBandIsNoFault) {
  const Vec3 half(0.03, 0.025, 0.02);
  const Field box = cubeField([=](const Vec3& p) { return boxDistance(p, half); },
                              0.06 / (150 - 16), 152); // band 8
  for (const double stiffness : {500.0, 1000.0}) {
    Scene scene = sceneOf(stiffness);
    scene.haptics.force_limit = 3.3;
    const auto snapshot = compileStages(scene, box);
    for (const double depth : {2.5e-3, 2.8e-3, 3e-3, 3.2e-3, 4e-3, 5e-3}) {
      const Vec3 edge(half.x(), half.y(), 0.37e-3);
      ContactMemory memory;
      glide(*snapshot, memory, edge + Vec3(1e-3, -depth - 4e-3, 0), 1e-4);
      Contact contact = glide(*snapshot, memory, edge + Vec3(-depth, -depth - 4e-3, 0), 7e-6);
      Vec3 last = contact.force;
      for (double along = -4e-3; along < 4e-3; along += 7e-6) {
        const Vec3 inwards(-depth - std::max(along, 0.0), -depth + std::min(along, 0.0), 0);
        contact = tick(*snapshot, memory, edge + inwards, 1e-3);
        ASSERT_FALSE(contact.fault) << depth << ' ' << along;
        ASSERT_TRUE(contact.touching);
        ASSERT_LT((contact.force - last).norm(), 1.2e-3 * stiffness) << depth << ' ' << along;
        last = contact.force;
      }
      EXPECT_GT(contact.normal.x(), 0.99); // the face where it came in
    }
  }
}

// P04 in the inner corner of a cube without one octant, where walls let the contact point move far
// in one tick: tips jump about inside at up to 1 m/s, much deeper than the band.
TEST(Crease, ContactPointMovesNoFartherATickThanItsLimit) {
  constexpr double kVoxel = 1e-3, kOwn = kSnapSides * 100 * kVoxel; // [m], [m/s]
  const Field corner = cubeField(
      [](const Vec3& p) {
        const Vec3 half = Vec3::Constant(0.04);
        return std::max(boxDistance(p, half), -boxDistance(p - half, half));
      },
      kVoxel, 100);
  const auto snapshot = compileStages(sceneOf(500), corner);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double farthest = 0, excess = 0;
  int touching = 0;
  for (const double speed : {0.2, 1.0}) {
    ContactMemory memory;
    Vec3 tip(0.01, 0.012, 0.008), velocity = Vec3::Zero();
    Contact last = tick(*snapshot, memory, tip, 1e-3);
    for (int i = 0; i < 60000; ++i) {
      velocity += 0.2 * speed * Vec3(uniform(random), uniform(random), uniform(random));
      if (velocity.norm() > speed) velocity *= speed / velocity.norm();
      const Vec3 next = tip + 1e-3 * velocity;
      for (int a = 0; a < 3; ++a)
        if (next[a] < -0.03 || next[a] > 0.014) velocity[a] = -velocity[a];
      tip += 1e-3 * velocity;
      const Contact now = tick(*snapshot, memory, tip, 1e-3);
      const double step = (tip - last.tip).norm(), ball = step + kOwn * 1e-3;
      if (now.touching && last.touching) {
        ++touching;
        farthest =
            std::max(farthest, (now.frictionless_point - last.frictionless_point).norm() / ball);
        excess = std::max(excess, (now.force - last.force).norm() - 500 * (step + ball));
      }
      last = now;
    }
  }
  std::printf("%d ticks in contact: c goes at most %.3f of what it may, step beyond it %.4f N\n",
              touching, farthest, excess);
  EXPECT_GT(touching, 60000);
  EXPECT_LE(farthest, 1.1);
  EXPECT_LE(excess, 0.01);
}

// J of the closest point, which such a crease constrains too.
TEST(Crease, PaintDoesNotChangeAcrossAFlatOne) {
  const Field field = planeField();
  const FieldSampler sampler(*field, Sampler::high);
  for (const double lean : {0.02, 0.05, 0.3}) {
    Contact contact;
    contact.touching = true;
    contact.tip = Vec3(0, 0, -1e-3);
    contact.normal = Vec3::UnitZ();
    contact.walls = 2;
    const double load = 0.5e-3 / std::cos(lean);
    contact.wall[0] = {Vec3(std::sin(lean), 0, std::cos(lean)), load};
    contact.wall[1] = {Vec3(-std::sin(lean), 0, std::cos(lean)), load};
    EXPECT_LT((pulledBack(sampler, contact, Vec3(3, 2, 0)) - Vec3(0, 2, 0)).norm(), 1e-12);
    contact.jacobian.reset(); // drops the Jacobian of the two walls
    contact.walls = 1;
    contact.wall[0] = {contact.normal, 1e-3};
    EXPECT_LT((pulledBack(sampler, contact, Vec3(3, 2, 0)) - Vec3(3, 2, 0)).norm(), 1e-6);
  }
}

} // namespace
} // namespace patina
