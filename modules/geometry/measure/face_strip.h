// Strips of faces, each sharing an edge with the next, and the shortest path within one.
#pragma once

#include <optional>
#include <vector>

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A vertex at which a path bends; `portal` is the edge between faces portal and portal + 1 of the
// strip, of which the vertex is an end.
struct StripCorner {
  std::int32_t vertex = -1;
  std::size_t portal = 0;
};

struct StripPath {
  double length = 0;
  std::vector<Vec3> points;         // start, a point on each crossed edge, end
  std::vector<StripCorner> corners; // in order
};

using FaceStrip = std::vector<std::int32_t>;

// Unfolds the strip into the plane and finds the shortest path in it from a point of its first face
// to one of its last (funnel algorithm, Lee & Preparata 1984).
StripPath shortestInStrip(const TriangleMesh& mesh, const FaceStrip& strip, const Vec3& start,
                          const Vec3& end);

// Walks from face to face round vertices. Both parts must outlive it.
class StripWalker {
 public:
  StripWalker(const TriangleMesh& mesh, const Adjacency& neighbours)
      : mesh_(mesh), neighbours_(neighbours) {}

  // Inserts the faces between faces that share only a vertex, and removes detours. nullopt if a gap
  // cannot be closed.
  std::optional<FaceStrip> joined(const FaceStrip& faces) const;
  // Returns the strip that passes the vertex on its other side; nullopt at a boundary.
  std::optional<FaceStrip> passedOnTheOtherSide(const FaceStrip& strip,
                                                const StripCorner& corner) const;

 private:
  std::optional<FaceStrip> fan(std::int32_t from, std::int32_t to, std::int32_t vertex,
                               std::int32_t first) const;
  bool has(std::int32_t face, std::int32_t vertex) const;
  std::array<std::int32_t, 2> besides(std::int32_t face, std::int32_t vertex) const;

  const TriangleMesh& mesh_;
  const Adjacency& neighbours_;
};

} // namespace patina
