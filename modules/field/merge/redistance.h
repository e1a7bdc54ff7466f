// Depths of a union measured to its own surface (F9).
#pragma once

#include <span>

#include "core/progress.h"
#include "field/merge/merge_fields.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct Redistanced {
  SurfaceField field;
  std::size_t nodes = 0; // that changed, coarse ones included
};

// `merged` is mergeFields(parts, lattice). Where the nearest point that min knows of lies inside
// another part, phi becomes the exact depth to the union's surface; if that is beyond the band the
// node is marked so. All other nodes are exact already and keep their bits; blocks without a change
// are shared. `joint` holds the parts' meshes in the world, one after another, without which there
// is nothing to measure to; the backs of plates are those of FieldPart::caps. No face layer throws
// invalid_argument. Surfaces of two parts that coincide count as surface. Parallel; polls
// `progress` and throws Cancelled.
Redistanced redistanced(const SurfaceField& merged, std::span<const FieldPart> parts,
                        const BlockLattice& lattice, const TriangleMesh& joint,
                        const Progress& progress);

} // namespace patina
