// The back and the sides of the plates whose fronts the one-sided parts of a mesh are.
#pragma once

#include <cmath>
#include <vector>

#include "core/progress.h"
#include "field/build/field_builder.h"
#include "geometry/mesh/open_parts.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

struct PlateCaps {
  TriangleMesh mesh;
  std::vector<std::int32_t> face; // by triangle of it: the face of the front that it lies behind
  std::size_t doubtful = 0;       // edges between a plate and another front, both within a voxel
};

// `builder`: distances of `mesh`, which is also in `tree`, signed with a plate `thickness` voxels
// thick, its band at least 1.5 voxels wider. Nodes next to each other on two sides with no front
// between them (their distances exceed the edge) have a cap between them: a quad, its corners in
// the means of where the plate ends along the edges of a cell. So a plate ends half-way to another
// front, and nothing ever stands out of a front. Within a voxel of a rim there are no caps, the rim
// itself is near. Which way the triangles turn says nothing. The same for any number of threads.
// Polls `progress` and throws Cancelled.
PlateCaps plateCaps(const FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                    const OpenParts& open, double thickness, const Progress& progress);

// Whether a node of a plate is nearest to a cap and not to the face that it names: of that it is
// farther than its phi says. Both in voxels.
inline bool nearsCap(float phi, double to_face) {
  constexpr double kRounding = 1e-3;
  return to_face > std::abs(static_cast<double>(phi)) + kRounding;
}

// Signs `builder`, of the same grid, like `like`, but for coarse nodes.
void signLike(FieldBuilder& builder, const FieldBuilder& like);

} // namespace patina
