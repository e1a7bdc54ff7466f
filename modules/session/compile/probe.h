// Values of a compiled scene at one point, for the window's probe and the command `sample`.
#pragma once

#include <limits>
#include <optional>

#include "authoring/brush/surface_values.h"
#include "geometry/tree/triangle_tree.h"
#include "session/compile/compile_scene.h"

namespace patina {

struct Probe {
  Vec3 position = Vec3::Zero(); // [m]
  double distance = 0;          // [m] from the surface with baked relief, negative inside
  Vec3 gradient = Vec3::Zero(); // gradient of the distance; zero where it is unknown
  bool in_band = false;         // the field stores this point
  // Nearest point of the surface; face -1 and an infinite distance if it is unknown.
  ClosestPoint closest{{}, Vec3::Zero(), std::numeric_limits<double>::infinity()};
  std::optional<std::size_t> object; // object of the nearest point
  SurfaceValues values;              // painted at the nearest point; the scene's own without
  std::optional<double> texture;     // height of a scanned texture at the nearest point [m]
};

// Returns the values at `p` [m]. Beyond the band the distance is exact if the nearest point is
// known, otherwise a bound. A point that is not finite gives NaN. Any thread.
// The nearest point is found among the field's nearest faces: known in the band only.
Probe probeAt(const CompiledScene& scene, const Vec3& p);
// The same with a nearest point that the caller has found; its face counts in scene.mesh.
Probe probeAt(const CompiledScene& scene, const Vec3& p, const ClosestPoint& closest);

} // namespace patina
