// The surface phi = iso of a field as triangles, block by block, so that an edited block is
// extracted alone (K26).
#pragma once

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Cells of one stored block; vertices on shared cell faces coincide bit for bit with the
// neighbour's. iso in metres, |iso| < band. Outward-facing (towards growing phi). Cells with a node
// beyond the band are left out: with |iso| <= band - 2 voxels none of them holds the surface.
// Vertex error O(h^2): phi is taken as linear along an edge. Throws invalid_argument for another
// iso or slot.
TriangleMesh isoSurfaceOfBlock(const SurfaceField& field, std::int32_t slot, double iso);

// All blocks, welded: closed if the iso-surface stays inside the band. Triangles are those of
// isoSurfaceOfBlock, slot after slot. Parallel.
TriangleMesh isoSurface(const SurfaceField& field, double iso);

} // namespace patina
