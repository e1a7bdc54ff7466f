// Painted material at any point of the world (K23).
#pragma once

#include "scene/scene.h"

namespace patina {

struct PaintedValue {
  double weight = 0; // weight of paint or of its added part; 0 where unpainted
  double value = 0;  // SI, paint composited over the scene's own value
};

// Interpolates trilinearly. Of several painted objects, the one with the largest weight counts.
PaintedValue paintedValue(const Scene& scene, MaterialChannel channel, const Vec3& world);

} // namespace patina
