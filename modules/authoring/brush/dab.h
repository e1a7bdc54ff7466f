// One dab of the brush: a sphere, or a sphere swept along a segment.
#pragma once

#include "core/types.h"
#include "scene/stroke.h"

namespace patina {

// Swept dabs weight every point by its distance to the path. Separate spheres would leave ripples
// that can be felt and that depend on the sample rate.
struct Dab {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(); // [m], world
  double radius_from = 0, radius_to = 0;       // [m]
  Vec3 front = Vec3::Zero();                   // world: only faces oriented this way; zero = all

  Vec3 centre() const { return 0.5 * (from + to); }
  // Returns the radius of a bounding sphere about the centre.
  double boundingRadius() const;
  Dab in(const Pose& other_from_world) const; // the same path in another frame
};

double weightAt(const Dab& dab, const Brush& brush, const Vec3& p); // K17

} // namespace patina
