// Painted layers as the stages render them, for tests.
#pragma once

#include "haptics/contact_fixture.h"
#include "support/painted_shapes.h"
#include "support/relief_image.h"

namespace patina {

using test::reliefImage;

inline HapticObject hapticMaterial(const MaterialMap& map, const Scene& scene) {
  HapticObject object;
  object.material = materialSamples(map, baseMaterial(scene.haptics), nullptr, nullptr);
  return object;
}

// Work of a closed path over these corners, from the last of them, by the trapezium rule [J, given
// to the hand].
inline double loopWork(const HapticSnapshot& snapshot, const std::vector<Vec3>& corners,
                       int steps = 4000) {
  ContactMemory memory;
  double work = 0;
  Vec3 last_force = tick(snapshot, memory, corners.back(), 1e-3).force, last_tip = corners.back();
  for (const Vec3& corner : corners) {
    const Vec3 from = last_tip;
    for (int i = 1; i <= steps; ++i) {
      const Vec3 tip = from + static_cast<double>(i) / steps * (corner - from);
      const Contact contact = tick(snapshot, memory, tip, 1e-3);
      EXPECT_FALSE(contact.fault);
      work += 0.5 * (contact.force + last_force).dot(tip - last_tip);
      last_force = contact.force;
      last_tip = tip;
    }
  }
  return work;
}

inline HapticObject hapticRelief(std::shared_ptr<const ReliefFaces> faces,
                                 std::shared_ptr<const TiledImage> image, double height,
                                 double greatest = 1) {
  HapticObject object;
  object.relief = reliefOn(std::move(faces), std::move(image), height);
  object.highest = std::abs(height) * greatest;
  return object;
}

} // namespace patina
