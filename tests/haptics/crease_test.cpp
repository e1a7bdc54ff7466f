#include <gtest/gtest.h>

#include "haptics/contact/pull_back.h"
#include "haptics/contact_fixture.h"

namespace patina {
namespace {

// Pressed 2.5 to 5 mm deep and slid across the bisector of a box's edge, at 7 um a tick, most of it
// deeper than the band: the contact point stays on the face where it is, however near the other.
TEST(Crease, SlidingAcrossAnEdgeDeeperThanTheBandIsNoFault) {
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
      EXPECT_GT(contact.normal.x(), 0.99); // of the face where it came in
    }
  }
}

// J of the closest point, which such a crease holds too.
TEST(Crease, WhatIsPaintedDoesNotChangeAcrossAFlatOne) {
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
    contact.walls = 1;
    contact.wall[0] = {contact.normal, 1e-3};
    EXPECT_LT((pulledBack(sampler, contact, Vec3(3, 2, 0)) - Vec3(3, 2, 0)).norm(), 1e-6);
  }
}

} // namespace
} // namespace patina
