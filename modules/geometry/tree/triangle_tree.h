// Exact closest point, ray and in-sphere queries over the triangles of a mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct ClosestPoint {
  SurfacePoint surface; // face = lowest index among (near-)equal distances
  Vec3 point;           // [m]
  double distance = 0;  // [m], unsigned
};

struct RayHit {
  SurfacePoint surface;
  double t = 0; // along the unit direction [m]
};

// Built in double precision about the mesh's own centre, so that coordinates far from the origin
// lose no accuracy. Immutable: queries may run on any number of threads. Holds its own copy. Every
// triangle must be finite (see cleaned()); throws std::invalid_argument otherwise or if empty.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);
  TriangleTree(TriangleTree&&) noexcept;
  TriangleTree& operator=(TriangleTree&&) noexcept;
  ~TriangleTree();

  // Exact. warm_face: a face that is probably near, such as a neighbour's answer; affects only the
  // speed. A point that is not finite gets face -1 and an infinite distance.
  ClosestPoint closestPoint(const Vec3& p, std::int32_t warm_face = -1) const;
  // Returns nullopt if nothing is within max_distance.
  std::optional<ClosestPoint> closestPointWithin(const Vec3& p, double max_distance,
                                                 std::int32_t warm_face = -1) const;
  // Returns the first hit with t in [0, max_t], on either side of a triangle. direction need not be
  // unit.
  std::optional<RayHit> firstHit(const Vec3& origin, const Vec3& direction, double max_t) const;
  // Returns all faces whose distance to the centre is <= radius, ascending.
  std::vector<std::int32_t> facesInSphere(const Vec3& centre, double radius) const;

  // Returns distances and faces of the side^3 points origin + spacing * (i, j, k), x fastest; side
  // even. Distances are in spacings; beyond max_distance [m] they are infinite and the face is -1.
  // Faces whose distances agree to 2e-6 relative plus 1e-7 of the mesh's extent are a tie, which
  // the lowest wins; the distance is that of the returned face. Several times faster than single
  // queries; side 8 is the fastest. Any number of threads.
  void closestOnLattice(const Vec3& origin, double spacing, int side, double max_distance,
                        std::span<float> distance, std::span<std::int32_t> face) const;

  std::size_t size() const;  // triangles
  std::size_t bytes() const; // held by this tree

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// Returns barycentric coordinates of the closest point of one triangle, exact in all seven Voronoi
// regions and for triangles without area.
Vec3 closestBarycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace patina
