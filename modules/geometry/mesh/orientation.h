// Finds misoriented triangles of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/vertex_weld.h"

namespace patina {

// Returns the indices, ascending, of the triangles to turn so that
// - faces that share an edge with just one other, vertices at equal positions being one, agree with
//   it, the smaller area of each connected part giving way (one-sided parts stay as they are), and
// - closed parts face the same way as most of the volume does. A part within the bounds of a larger
//   closed one may be a cavity: it keeps facing as it does relative to that one.
// A mesh that is turned inside out as a whole stays so. Corners must be finite. `welded`: the
// weldedTriangles() of `mesh`.
std::vector<std::int32_t> misorientedTriangles(const TriangleMesh& mesh,
                                               const std::vector<Triangle>& welded);
inline std::vector<std::int32_t> misorientedTriangles(const TriangleMesh& mesh) {
  return misorientedTriangles(mesh, weldedTriangles(mesh));
}

} // namespace patina
