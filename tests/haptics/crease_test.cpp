#include <gtest/gtest.h>

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

} // namespace
} // namespace patina
