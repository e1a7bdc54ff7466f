// The surface under the mouse, found in the field: no depth buffer, no mesh.
#pragma once

#include <optional>

#include "field/store/surface_field.h"
#include "scene/scene.h"

namespace patina {

// First point of the ray where phi falls to 0, to a hundredth of a voxel. direction is unit.
// nullopt if the ray misses. Needs no sample layer.
std::optional<Vec3> firstSurfaceAlong(const SurfaceField& field, const Vec3& origin,
                                      const Vec3& direction);

// The point of the mesh nearest to `p` among the faces that the field names in p's cell and those
// beside it; exact where p is on the surface and edges are no shorter than a voxel. `mesh` is the
// one that the field was built from. nullopt if the field knows no face there.
std::optional<SurfacePoint> surfacePointAt(const SurfaceField& field, const TriangleMesh& mesh,
                                           const Vec3& p);

// A point of the scene's joint mesh (its objects one after another) as one of an object's own.
struct ObjectPoint {
  std::size_t object = 0;
  SurfacePoint point; // on the object's mesh: its faces count from 0
};
std::optional<ObjectPoint> objectPointOf(const Scene& scene, const SurfacePoint& joint);

} // namespace patina
