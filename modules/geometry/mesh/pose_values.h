// A pose as six numbers to type (A09).
#pragma once

#include "core/types.h"

namespace patina {

// Translation and rotations about the fixed axes, first x, then y, then z (R = Rz Ry Rx).
struct PoseValues {
  Vec3 position_mm = Vec3::Zero();
  Vec3 angles_deg = Vec3::Zero(); // x in -180 .. 180, y in -90 .. 90, z in -180 .. 180
};

Pose poseOf(const PoseValues& values);
// poseOf(valuesOf(p)) is p; at y = +-90 degrees, where x and z are the same rotation, z is 0.
PoseValues valuesOf(const Pose& pose);

} // namespace patina
