// Which side of the surface each node lies on (K01).
#pragma once

#include <cstddef>

#include "core/progress.h"
#include "field/build/field_builder.h"
#include "geometry/mesh/open_parts.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tree/triangle_tree.h"
#include "geometry/winding/winding_number.h"

namespace patina {

// Signs the distances and the top table of `builder`, whose distances must be
// exact to 5e-4 voxel (FieldBuilder says what else). Returns how many nodes are ambiguous: the
// rules disagree there and the majority stands.
//
// Nodes p, q with d(p) + d(q) > |pq| lie on one side, for the surface cannot cross between them.
// Nodes so connected share one sign: the majority of winding numbers, |w| > 1/2 being inside, taken
// where each block's share of them is deepest. |w|, so that an inverted mesh has an inside. Where
// the votes are mixed and the mesh has open edges, the component leaks through a hole: it is cut
// where neighbouring votes change, and there every node asks for itself. Slivers beside the surface
// take the sign of a node that they can see, or else their own winding number. A node on the
// surface (within 1e-6 voxel) counts as outside.
//
// All that holds of the closed parts of `mesh`, which `winding` is of (not read if there is none).
// Beside an open part there is no inside for a winding number to find: it is the front of a plate,
// and a node whose nearest face is open is in it if it lies behind that (FrontSide), not past the
// rim, and nearer than `thickness` voxels. Without a thickness both sides are outside. Nodes inside
// a closed part stay so. The values are still the distances to `mesh`: see plate.h for the rest.
//
// All of `mesh` in tree. Parallel, and the same for any number of threads. Polls `progress` and
// throws Cancelled (builder is then half done).
std::size_t assignSigns(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                        const WindingNumber& winding, const OpenParts& open, double thickness,
                        Progress& progress);

// The coarse nodes, like the nodes that lie where they do.
void signCoarse(FieldBuilder& builder);

} // namespace patina
