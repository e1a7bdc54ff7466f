// Which side of the surface each node lies on (K01).
#pragma once

#include <cstddef>

#include "core/progress.h"
#include "field/field_builder.h"
#include "geometry/open_parts.h"
#include "geometry/triangle_mesh.h"
#include "geometry/triangle_tree.h"
#include "geometry/winding_number.h"

namespace patina {

// Signs the distances, the top table and the coarse nodes of `builder`, whose distances must be
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
// Beside an open part there is no inside for a winding number to find: a node whose nearest face is
// open lies behind it (FrontSide), negative, or not, and beyond the rim there is nothing. With
// OpenSides::two both sides are positive. Behind the band nothing is known, and so outside: a sheet
// is a slab as deep as the band, only the coarse nodes say how far behind it they are. Nodes inside
// a closed part stay so. Ambiguous are nodes within kRim voxels of a rim and behind it.
//
// All of `mesh` in tree. Parallel, and the same for any number of threads. Polls `progress` and
// throws Cancelled (builder is then half done).
inline constexpr float kRim = 2;
std::size_t assignSigns(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                        const WindingNumber& winding, const OpenParts& open, OpenSides sides,
                        Progress& progress);

} // namespace patina
