// Finds duplicate faces inside a body.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/vertex_weld.h"

namespace patina {

// Returns the indices, ascending, of the triangles that occur twice (vertices at equal positions
// merged) and lie inside the body of all others, where the winding number is at least 0.75: the
// faces between the cells of a tetrahedral mesh, or the wall between two touching bodies. A mesh in
// which all triangles occur twice has none. Degenerate triangles must be left out, corners be
// finite. Parallel, with the same result for any number of threads.
// `welded`: the weldedTriangles() of `mesh`.
std::vector<std::int32_t> innerFaces(const TriangleMesh& mesh, const std::vector<Triangle>& welded);
inline std::vector<std::int32_t> innerFaces(const TriangleMesh& mesh) {
  return innerFaces(mesh, weldedTriangles(mesh));
}

} // namespace patina
