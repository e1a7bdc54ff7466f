// The surface of a union: of each object's triangles what no other object hides (F9).
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/progress.h"
#include "field/merge/merge_fields.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A point is hidden by another part that it lies deeper in than this [voxel]: surfaces that merely
// coincide stay.
inline constexpr double kHiddenFrom = 0.02;

// Of each part's field.
std::deque<NodeReader> nodesOf(std::span<const FieldPart> parts);

// Whether a point that belongs to `owner` is hidden; `nodes` are those of the parts. q in grid
// coordinates of the lattice.
bool isHidden(std::span<const FieldPart> parts, const std::deque<NodeReader>& nodes,
              std::int32_t owner, const Vec3& q);

struct UnionSurface {
  TriangleMesh mesh;              // corners are not shared
  std::vector<std::int32_t> face; // by triangle: of the joint mesh
};

// Triangles that enter another part are cut there, to O(h^2) of a cut: pieces of at most a voxel,
// each cut straight. `joint` holds the parts' meshes one after another, in the world; degenerate
// and non-finite triangles are left out. Parallel; polls `progress` and throws Cancelled.
UnionSurface unionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                          const TriangleMesh& joint, const Progress& progress);

// The same with the backs and the sides of the parts' plates.
UnionSurface closedUnionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                                const TriangleMesh& joint, const Progress& progress);

} // namespace patina
