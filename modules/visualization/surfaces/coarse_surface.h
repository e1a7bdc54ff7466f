// A mesh with fewer triangles, to be seen while the camera moves.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Vertices that share a cell of a grid of `cells` along the longest side become their mean;
// triangles that lose a corner go, and so do those with a corner that is not finite. Linear in the
// triangles.
TriangleMesh coarsened(const TriangleMesh& mesh, int cells);

} // namespace patina
