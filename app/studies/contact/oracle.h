// Contact by its definition (P01), computed on the triangles in double precision: the
// reference for every contact stage, with which it shares no code.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Exact signed distance of the union of meshes in the world frame. Immutable, thread-safe.
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
  // Nearest point of the mesh with the smallest distance. The sign is that of the angle-weighted
  // pseudonormal (Bærentzen & Aanæs 2005), correct for closed meshes without self-intersections. An
  // open mesh has no inside; its distance is not negative.
  Nearest nearest(const Vec3& p) const;
  double distance(const Vec3& p) const { return nearest(p).distance; }

  // Corners of all triangles of all meshes within `radius` of the centre [m].
  std::vector<Eigen::Matrix3d> trianglesNear(const Vec3& centre, double radius) const;

  const std::vector<TriangleMesh>& meshes() const;
  Box3 bounds() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// Min distance of the contact point from the triangles at iso 0 [m]; 5e-5 N at 500 N/m.
inline constexpr double kMinIso = 1e-7;

struct ProxyAnswer {
  Vec3 point = Vec3::Zero(); // c [m]
  bool found = false;        // false: no free point was found near the seed
  bool at_ball = false;      // the ball limited the motion
  int steps = 0;
};

// Local minimum of |c - tip| subject to distance(c) >= iso and |c - seed| <= ball, by descent from
// the seed (P01, P04). A seed that is too deep is first moved, with the ball, to the nearest
// point where distance = iso.
// Each step projects the tip onto half-spaces that contain the present point and keep it away from
// some triangles by iso. Every step is thus a straight line through free space along which |c -
// tip| decreases, and cannot pass a wall, however thin. At the end nearby points are tested before
// the result counts as a minimum.
ProxyAnswer proxyOracle(const ExactSurface& surface, double iso, const Vec3& tip, const Vec3& seed,
                        double ball);

// Nearest point with distance >= iso, found by moving out of close obstacles; `found` is false if
// there is none close by.
ProxyAnswer projectedOutside(const ExactSurface& surface, double iso, const Vec3& p);

// Returns true if the tip is deeper than `margin` [m], by the distance alone.
inline bool isCertainlyInside(const ExactSurface& surface, double iso, double margin,
                              const Vec3& tip) {
  return surface.distance(tip) < iso - margin;
}

} // namespace patina
