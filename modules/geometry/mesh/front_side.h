// In front of, behind or past the rim of an open mesh.
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

enum class Side : std::uint8_t { front, back, past };

// Sides of points by the nearest point of a mesh: by the face's normal, on edges and vertices by
// the mean of the normals about, angle-weighted, which tells right from wrong wherever the surface
// does not cut itself. Where the nearest point lies on the rim and the point does not stand over
// the surface, it is past the rim. Of coincident triangles the lowest counts.
// Immutable; any thread.
class FrontSide {
 public:
  // The faces with open[face] != 0; the mesh must outlive this. `seams`: edges with one face that
  // are no rim.
  FrontSide(const TriangleMesh& mesh, const std::vector<std::uint8_t>& open,
            const std::vector<FaceEdge>& seams = {});

  // `face`: an open one that holds the point of the mesh nearest to p.
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
  std::vector<Triangle> vertices_; // by face, as Corners are numbered
  std::vector<std::int32_t> twin_; // by face
  std::vector<Corner> corners_;
  std::vector<std::array<std::int32_t, 3>> edge_of_; // by face
  std::vector<Edge> edges_;
};

} // namespace patina
