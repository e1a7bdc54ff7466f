// Faces inside a body that say nothing about its surface.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Indices, ascending, of the triangles that are there twice, vertices at equal positions being one,
// and lie inside the body that all others bound, where their winding number is 0.75 off 0: those
// between the cells of a tetrahedral mesh, or the wall between two bodies that touch. A mesh all of
// whose triangles are there twice has none. Degenerate triangles must be left out, corners be
// finite. Parallel, and the same for any number of threads.
std::vector<std::int32_t> innerFaces(const TriangleMesh& mesh);

} // namespace patina
