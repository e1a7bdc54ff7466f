// Measures depths inside a union from the union's own surface (F9).
#pragma once

#include <span>

#include "core/progress.h"
#include "field/merge/merge_fields.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct Redistanced {
  SurfaceField field;
  std::size_t nodes = 0; // changed nodes, coarse ones included
};

// `merged` is mergeFields(parts, lattice). If the nearest point of a node's part lies inside
// another part, phi becomes the exact depth below the union's surface, or the background value
// beyond the band. All other nodes keep their exact values; blocks without a change are shared.
// `joint` holds the parts' meshes one after another, in the world; FieldPart::caps adds the backs
// of sheets. Throws invalid_argument without a face layer. Coinciding surfaces of two parts count
// as surface. Parallel; polls `progress` and throws Cancelled.
Redistanced redistanced(const SurfaceField& merged, std::span<const FieldPart> parts,
                        const BlockLattice& lattice, const TriangleMesh& joint,
                        const Progress& progress);

} // namespace patina
