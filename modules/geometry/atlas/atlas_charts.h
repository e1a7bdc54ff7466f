// Cuts a surface into charts (K16): connected faces that one plane can show. Internal to the atlas.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Mesh on which charts grow. Vertices at equal positions are merged, so that a crack in the indices
// is no boundary; positions are relative to the middle of the mesh.
struct AtlasSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals; // zero: without area or a duplicate, in no chart
  std::vector<double> areas;
  // Neighbour across each edge: the one other face there, if it has the opposite edge direction.
  std::vector<std::array<std::int32_t, 3>> neighbours;
  std::vector<std::int32_t> vertex_offsets, vertex_faces; // see Adjacency
  // A duplicate face of the same orientation, and the first face of its set.
  struct Duplicate {
    std::int32_t face, first;
  };
  std::vector<Duplicate> duplicates;
};
AtlasSurface atlasSurface(const TriangleMesh& mesh);

struct Chart {
  std::vector<std::int32_t> faces; // connected across edges
  Vec3 normal = Vec3::UnitZ();     // normal of the chart's plane
};

// Smallest cosine between a face and its chart's plane: no face is stretched by more than 2.
inline constexpr double kMinCosine = 0.5;

// Returns regions of faces with the same nearest axis. A region smaller than `small_area` is joined
// to a neighbour if one plane can show both, a larger one only if the stretch stays small. Parts of
// a chart may still overlap on its plane. Deterministic.
std::vector<Chart> grownCharts(const AtlasSurface& surface, double small_area);

} // namespace patina
