// Painted material at any point of the world (K23).
#pragma once

#include "scene/scene.h"

namespace patina {

struct PaintedValue {
  double weight = 0; // how much of it is paint, or was added; 0 where nothing is painted
  double felt = 0;   // SI: paint over the scene's own value
};

// Trilinear. Where several objects are painted, that of the greatest weight.
PaintedValue paintedValue(const Scene& scene, MaterialChannel channel, const Vec3& world);

} // namespace patina
