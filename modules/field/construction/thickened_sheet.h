// Back and sides (caps) of the sheets whose fronts are the one-sided open parts of a mesh.
#pragma once

#include <cmath>
#include <vector>

#include "core/progress.h"
#include "field/store/field_builder.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/sides/open_parts.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

struct SheetCaps {
  TriangleMesh mesh;
  std::vector<std::int32_t> face; // front face before each triangle
  std::size_t doubtful = 0;       // edges between a sheet and another front, both within a voxel
};

// `builder` has the distances of `mesh`, which is also in `tree`, signed with sheets `thickness`
// voxels thick; its band is at least 1.5 voxels wider. Two neighbouring nodes of opposite sign
// without a front between them (their distances exceed the edge) have a cap between them: a
// quadrilateral whose corners are the means of the sheet's ends along the edges of a cell. So a
// sheet ends half-way to another front and never protrudes from a front. There are no caps within a
// voxel of a boundary, which is near enough itself. The orientation of the triangles is undefined.
// The result does not depend on the number of threads. Polls `progress` and throws Cancelled.
SheetCaps sheetCaps(const FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                    const OpenParts& open, double thickness, const Progress& progress);

// Returns true if a node in a sheet is closer to a cap than to its named face, which is then
// farther away than |phi|. Both in voxels.
inline bool isClosestToCap(float phi, double to_face) {
  constexpr double kRounding = 1e-3;
  return to_face > std::abs(static_cast<double>(phi)) + kRounding;
}

// Copies the signs of `like`, on the same grid, to `builder`, except those of coarse nodes.
void copySigns(FieldBuilder& builder, const FieldBuilder& like);

} // namespace patina
