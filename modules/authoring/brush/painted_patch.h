// Area of painted patches.
#pragma once

#include <optional>
#include <string>

#include "geometry/mesh/adjacency.h"
#include "scene/scene.h"

namespace patina {

struct PaintedPatch {
  std::string what; // "color", "relief" or the key of a material channel
  double area = 0;  // [m²]
};

// Returns the connected patch about a point of an object's mesh on which colour covers half or
// more, without colour a material channel, without that the relief has half its height at the
// point. nullopt: nothing is painted there. `neighbours`: of the object's mesh.
std::optional<PaintedPatch> paintedPatchAt(const Scene& scene, std::size_t object,
                                           const SurfacePoint& point, const Adjacency& neighbours);

} // namespace patina
