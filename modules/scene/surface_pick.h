// Picks surface points in the field, without depth buffer or mesh.
#pragma once

#include <optional>

#include "field/store/surface_field.h"
#include "scene/scene.h"

namespace patina {

// Returns the first point of the ray with phi <= 0, to a hundredth of a voxel; its start if that is
// inside. direction is unit. nullopt if the ray misses. Needs no sample layer.
std::optional<Vec3> firstSurfaceAlong(const SurfaceField& field, const Vec3& origin,
                                      const Vec3& direction);
// Returns the first point of the ray at which phi crosses `level` [m], from either side. nullopt if
// there is none within the grid.
std::optional<Vec3> firstCrossingAlong(const SurfaceField& field, const Vec3& origin,
                                       const Vec3& direction, double level);

// Returns phi [m] at a point of the world, interpolated trilinearly; not beyond the band.
double distanceAt(const SurfaceField& field, const Vec3& p);

// Returns the mesh point nearest to `p` among the field's nearest faces in p's cell and its
// neighbours; exact for p on the surface and edges of at least a voxel. `mesh` is the mesh of the
// field. nullopt if there are no such faces.
std::optional<SurfacePoint> surfacePointAt(const SurfaceField& field, const TriangleMesh& mesh,
                                           const Vec3& p);

// Converts a point of the scene's combined mesh (objects in order) to one of an object's mesh.
struct ObjectPoint {
  std::size_t object = 0;
  SurfacePoint point; // on the object's mesh: faces count from 0
};
std::optional<ObjectPoint> objectPointOf(const Scene& scene, const SurfacePoint& joint);

} // namespace patina
