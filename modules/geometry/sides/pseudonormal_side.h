// Side of a point relative to an open mesh: in front, behind or beyond its boundary.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct FaceEdge {
  std::int32_t face;
  int edge; // from corner `edge` to the next
};

enum class Side : std::uint8_t { front, back, beyond_boundary };

// Determines sides from the nearest point of a mesh by its angle-weighted pseudonormal (Baerentzen
// & Aanaes 2005), which is correct if the surface does not intersect itself. A point beyond the
// boundary has its nearest point on it and does not project onto the surface. The lowest of
// duplicate faces counts. Immutable; any thread.
class PseudonormalSide {
 public:
  // Uses the faces with open[face] != 0; the mesh must outlive this. `seams`: edges with one face
  // that are no boundary.
  PseudonormalSide(const TriangleMesh& mesh, const std::vector<std::uint8_t>& open,
                   const std::vector<FaceEdge>& seams = {});

  // `face`: the open face that holds the point of the mesh nearest to p.
  Side at(const Vec3& p, std::int32_t face) const;

 private:
  struct Corner { // sums over the faces about a vertex
    Vec3 normal = Vec3::Zero(), outward = Vec3::Zero();
    bool rim = false;
  };
  struct Edge {
    Vec3 normal = Vec3::Zero();
    bool rim = false;
  };

  const TriangleMesh& mesh_;
  std::vector<Triangle> vertices_;            // corners of each face, as indices into corners_
  std::vector<std::int32_t> first_duplicate_; // first duplicate of each face
  std::vector<Corner> corners_;
  std::vector<std::array<std::int32_t, 3>> edge_of_; // edges of each face, as indices into edges_
  std::vector<Edge> edges_;
};

} // namespace patina
