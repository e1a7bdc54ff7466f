// One dab of the brush: a sphere, or where its weight is taken only once, a sphere swept along.
#pragma once

#include "core/types.h"
#include "scene/stroke.h"

namespace patina {

// Swept, so that a stroke weighs every place by its distance to the path: dabs side by side would
// leave ripples that are felt, and other ones at another rate of samples.
struct Dab {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(); // [m], world
  double radius_from = 0, radius_to = 0;       // [m]
  Vec3 front = Vec3::Zero();                   // world: only what looks this way; zero = any side

  Vec3 centre() const { return 0.5 * (from + to); }
  // Of a sphere about the centre that holds all of it.
  double reach() const;
  Dab in(const Pose& other_from_world) const; // the same path in another frame
};

double weightAt(const Dab& dab, const Brush& brush, const Vec3& p); // K17

} // namespace patina
