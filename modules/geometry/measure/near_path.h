// Faces near a shortest path over a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Returns the faces within four rings of a path from vertex to vertex, ascending; empty if no faces
// connect the points. The path follows distances by fast marching (Kimmel & Sethian 1998), each
// from a virtual source in the plane of the face (Novotni & Klein 2002): exact over flat faces, and
// otherwise good to about 0.1 % where the faces are small. Throws Cancelled.
std::vector<std::int32_t> facesNearPath(const TriangleMesh& mesh, const Adjacency& neighbours,
                                        const SurfacePoint& from, const SurfacePoint& to,
                                        const Progress& progress);

} // namespace patina
