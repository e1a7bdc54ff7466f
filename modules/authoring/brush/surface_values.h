// Painted values at one point, for picking and the eyedropper.
#pragma once

#include <array>
#include <optional>

#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene.h"

namespace patina {

struct SurfaceValues {
  std::array<double, 4> color{}; // premultiplied sRGB and coverage; 0 where unpainted
  double height = 0;             // [m] of relief
  Material material;             // paint composited over the scene's values
};

// `point` on the object's own mesh (its faces count from 0).
SurfaceValues surfaceValues(const Scene& scene, std::size_t object, const SurfacePoint& point);

} // namespace patina
