// Determines the side of the surface of each node (K01).
#pragma once

#include <cstddef>

#include "core/progress.h"
#include "field/store/field_builder.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/sides/open_parts.h"
#include "geometry/tree/triangle_tree.h"
#include "geometry/winding/winding_number.h"

namespace patina {

// Signs the distances and block_index of `builder`, whose distances must be exact to 5e-4 voxel
// (see FieldBuilder). Returns the number of ambiguous nodes, at which the rules disagree and the
// majority decides.
//
// Nodes p, q with d(p) + d(q) > |pq| lie on one side, because the surface cannot cross between
// them. Connected nodes share one sign: the majority vote of winding numbers, |w| > 1/2 meaning
// inside, evaluated at the deepest node of each block's part. |w|, so that an inverted mesh has an
// inside. If the votes are mixed and the mesh has open edges, the component leaks through a hole:
// it is cut where neighbouring votes change, and each node there gets its own winding number.
// Slivers at the surface take the sign of a node visible from them, or else of their own winding
// number. A node on the surface (within 1e-6 voxel) counts as outside.
//
// This applies to the closed parts of `mesh`, which `winding` describes (not read if there are
// none). An open part has no inside: it is the front of a thickened sheet. A node whose nearest
// face is open lies in the sheet if it is behind that face (PseudonormalSide), not beyond the
// boundary, and closer than `thickness` voxels. Without a thickness both sides are outside. Nodes
// inside a closed part stay so. Values remain the distances to `mesh`; thickened_sheet.h completes
// them.
//
// `tree` holds all of `mesh`. Parallel, with the same result for any number of threads. Polls
// `progress` and throws Cancelled, leaving `builder` incomplete.
std::size_t assignSigns(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                        const WindingNumber& winding, const OpenParts& open, double thickness,
                        Progress& progress);

// Copies the signs of the nodes at the same positions to the coarse nodes.
void signCoarse(FieldBuilder& builder);

} // namespace patina
