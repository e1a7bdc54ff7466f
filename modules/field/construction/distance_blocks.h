// Finds the blocks in the band and the unsigned distances of their nodes (K01, K02).
#pragma once

#include "core/progress.h"
#include "field/store/field_builder.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// Returns every block with a node in the band, exact there, and the coarse nodes, exact everywhere;
// all unsigned. `tree` holds the triangles of `mesh`. Parallel, with the same result for any number
// of threads; polls `progress` and throws Cancelled; reports between the given fractions.
FieldBuilder distanceBlocks(const TriangleMesh& mesh, const TriangleTree& tree,
                            const FieldGrid& grid, double band, Progress& progress,
                            double from_fraction, double to_fraction);

} // namespace patina
