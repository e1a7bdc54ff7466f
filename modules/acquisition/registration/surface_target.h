// What a path is registered to: a mesh, with the path's points `offset` in front of it.
#pragma once

#include <optional>

#include "geometry/mesh/front_side.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// How far a point is from where it should be, and in which direction that grows.
struct Miss {
  double distance = 0; // in front of where it should be is positive where there is an offset [m]
  Vec3 direction = Vec3::UnitZ(); // unit: the distance's gradient
  SurfacePoint foot;
  Vec3 at = Vec3::Zero(); // of the mesh, nearest [m]
};

// Immutable once made; any thread.
class SurfaceTarget {
 public:
  // Throws std::invalid_argument as TriangleTree does. Unless the offset [m] is 0 and it is not
  // `sided` the front of the surface differs from its back.
  SurfaceTarget(TriangleMesh mesh, double offset, bool sided = false);
  SurfaceTarget(const SurfaceTarget&) = delete;
  SurfaceTarget& operator=(const SurfaceTarget&) = delete;

  // warm_face: see TriangleTree::closestPoint().
  Miss miss(const Vec3& p, std::int32_t warm_face = kNone) const;

  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  double offset() const { return offset_; }
  bool hasSides() const { return side_.has_value(); }
  double extent() const { return extent_; } // the bounding box's diagonal [m]
  // By how much its flat faces leave the surface that they stand for, about this face [m].
  double facetError(std::int32_t face) const;

 private:
  TriangleMesh mesh_;
  TriangleTree tree_;
  double offset_;
  double extent_ = bounds(mesh_).sizes().norm();
  std::vector<float> facet_error_; // by vertex
  std::optional<FrontSide> side_;  // where there is an offset
};

} // namespace patina
