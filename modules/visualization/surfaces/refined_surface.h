// Refines a surface so that its vertices can carry values.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {

struct RefinedSurface {
  TriangleMesh mesh;                // the same surface, with texture coordinates if present
  CornerNormals normals;            // smooth like the coarse surface's; not of unit length
  std::vector<std::int32_t> parent; // per triangle, its face in the original mesh
};

// Halves edges until none is longer than max_edge [m]; faces that share an edge share its new
// vertices. Edges stay longer if there would be more than about `most` triangles. Triangles with a
// corner that is not finite are left out. Throws invalid_argument unless max_edge > 0.
RefinedSurface refined(const TriangleMesh& mesh, double max_edge, std::size_t most = 400'000);

} // namespace patina
