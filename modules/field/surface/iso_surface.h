// The surface phi = iso of a field as triangles.
#pragma once

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// All blocks, welded: closed if the iso-surface stays inside the band. Block by block in the order
// of their slots; bitwise the same however many threads. iso in metres, |iso| < band.
// Outward-facing (towards growing phi). Cells with a node beyond the band are left out: with |iso|
// <= band - 2 voxels none of them holds the surface. Vertex error O(h^2): phi is taken as linear
// along an edge. Throws invalid_argument for another iso. Parallel.
TriangleMesh isoSurface(const SurfaceField& field, double iso);

} // namespace patina
