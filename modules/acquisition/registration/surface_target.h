// Target of a registration: a mesh with the path's points at a distance `offset` in front of it.
#pragma once

#include <optional>

#include "geometry/sides/pseudonormal_side.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// Residual of a point: distance from its expected position, with gradient and closest point.
struct SurfaceResidual {
  double distance = 0; // positive in front of the expected position if there is an offset [m]
  Vec3 direction = Vec3::UnitZ(); // gradient of the distance, unit
  SurfacePoint foot;
  Vec3 at = Vec3::Zero(); // closest point of the mesh [m]
};

// Immutable; may be used from any thread.
class SurfaceTarget {
 public:
  // Throws std::invalid_argument as TriangleTree does, and Error if the offset, the radius of a
  // probe's tip, exceeds half the mesh's longest side: their units then differ. Front and back are
  // distinguished if the offset [m] is not 0 or `sided` is true.
  SurfaceTarget(TriangleMesh mesh, double offset, bool sided = false);
  SurfaceTarget(const SurfaceTarget&) = delete;
  SurfaceTarget& operator=(const SurfaceTarget&) = delete;

  // warm_face: see TriangleTree::closestPoint().
  SurfaceResidual residual(const Vec3& p, std::int32_t warm_face = kNone) const;

  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  double offset() const { return offset_; }
  bool hasSides() const { return side_.has_value(); }
  double extent() const { return extent_; } // diagonal of the bounding box [m]
  // Returns the chordal error of the flat faces about this face [m].
  double chordError(std::int32_t face) const;

 private:
  TriangleMesh mesh_;
  TriangleTree tree_;
  double offset_;
  double extent_ = bounds(mesh_).sizes().norm();
  std::vector<float> facet_error_;       // one per vertex
  std::optional<PseudonormalSide> side_; // set if front and back are distinguished
};

} // namespace patina
