// Contact as it is defined (P01), worked out on the triangles themselves in double precision: the
// judge of every contact stage, with which it shares no code.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Exact signed distance of the union of meshes in the world frame. Immutable, any thread.
class ExactSurface {
 public:
  // Every triangle must be usable (see cleaned()).
  explicit ExactSurface(std::vector<TriangleMesh> meshes);
  ExactSurface(ExactSurface&&) noexcept;
  ExactSurface& operator=(ExactSurface&&) noexcept;
  ~ExactSurface();

  struct Nearest {
    Vec3 point = Vec3::Zero();   // [m], on the surface
    Vec3 outward = Vec3::Zero(); // unit; angle-weighted at edges and vertices
    double distance = 0;         // [m]; negative inside where the mesh is closed
  };
  // Of the mesh with the least distance. The sign is that of the angle-weighted pseudonormal at the
  // nearest point: right everywhere about a closed mesh that does not cut itself. A mesh that is
  // not closed has no inside; its distance is not negative.
  Nearest nearest(const Vec3& p) const;
  double distance(const Vec3& p) const { return nearest(p).distance; }

  // Corners of all triangles within `radius` of the centre [m], of all meshes.
  std::vector<Eigen::Matrix3d> trianglesNear(const Vec3& centre, double radius) const;

  const std::vector<TriangleMesh>& meshes() const;
  Box3 bounds() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// At iso 0 the contact point keeps this far from the triangles [m]; 5e-5 N at 500 N/m.
inline constexpr double kLeastIso = 1e-7;

struct ProxyAnswer {
  Vec3 point = Vec3::Zero(); // c [m]
  bool found = false;        // false: no point out of the surface was found near the seed
  bool at_ball = false;      // stopped by the ball, would go on
  int steps = 0;
};

// The local argmin |c - tip| subject to distance(c) >= iso and |c - seed| <= ball that descent from
// the seed comes to (P01, P04). A seed that lies too deep is first moved to the nearest place where
// distance = iso, and the ball with it.
//
// Each step projects the tip onto half-spaces that hold the present point, each of which keeps away
// from some triangles by iso. So every step is a straight line through free space along which
// |c - tip| falls: the way cannot pass through a wall, however thin. Where nothing more is gained,
// points about the end are tried, too, before it counts as a minimum.
ProxyAnswer proxyOracle(const ExactSurface& surface, double iso, const Vec3& tip, const Vec3& seed,
                        double ball);

// The nearest place with distance >= iso, found by going out of what is too near; nullopt-like:
// `found` is false if there is none close by.
ProxyAnswer movedOut(const ExactSurface& surface, double iso, const Vec3& p);

// The tip is deeper than `margin` [m], whatever came before: certain from the distance alone.
inline bool surelyInside(const ExactSurface& surface, double iso, double margin, const Vec3& tip) {
  return surface.distance(tip) < iso - margin;
}

} // namespace patina
