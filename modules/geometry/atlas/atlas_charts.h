// Cuts a surface into charts: connected faces that one plane can show (K16). Internal to the atlas.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A mesh as charts grow over it. Vertices at equal positions are one, so that a crack in the
// indices is no border; positions are about the middle of the mesh.
struct AtlasSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals; // zero = without area, or a twin: in no chart
  std::vector<double> areas;
  // Across each edge: the one other face there, if it runs along the edge the other way.
  std::vector<std::array<std::int32_t, 3>> neighbours;
  std::vector<std::int32_t> vertex_offsets, vertex_faces; // as in Adjacency
  // Faces that lie on an earlier one and face the same way, and that one.
  struct Twin {
    std::int32_t face, first;
  };
  std::vector<Twin> twins;
};
AtlasSurface atlasSurface(const TriangleMesh& mesh);

struct Chart {
  std::vector<std::int32_t> faces; // connected across edges
  Vec3 normal = Vec3::UnitZ();     // of its plane
};

// Cosine between a face and its chart's plane at least: no face is stretched by more than 2.
inline constexpr double kLeastCosine = 0.5;

// Regions by the nearest axis, and those below `small_area` joined to neighbours wherever one plane
// can show both; larger ones where it can without much stretch. Parts of a chart may still cover
// each other on its plane. Deterministic.
std::vector<Chart> grownCharts(const AtlasSurface& surface, double small_area);

} // namespace patina
