// Area of the part of a mesh on which a function of its points is high.
#pragma once

#include <functional>

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Returns the area [m²] of the connected part about `at` where cover(point) >= 0.5; 0 if it is less
// at `at`. Faces are divided into cells, fine enough for 0.3 % of a disc's area, and a cell counts
// if its middle does.
double patchArea(const TriangleMesh& mesh, const Adjacency& neighbours, const SurfacePoint& at,
                 const std::function<double(const SurfacePoint&)>& cover);

} // namespace patina
