// A surface in triangles small enough to carry values at their corners.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {

struct RefinedSurface {
  TriangleMesh mesh;                // the same surface; with texture coordinates if it had them
  CornerNormals normals;            // as smooth as the coarse surface's; not of unit length
  std::vector<std::int32_t> parent; // of each triangle, its face in the mesh that was refined
};

// Halves edges until none is longer than max_edge [m]; faces that share an edge share its new
// vertices. Where that would give more than about `most` triangles, edges stay longer, but no edge
// is ever joined. Triangles with a corner that is not finite are left out. Throws invalid_argument
// unless max_edge > 0.
RefinedSurface refined(const TriangleMesh& mesh, double max_edge, std::size_t most = 400'000);

} // namespace patina
