// Surface of a union: the pieces of each object's triangles that no other object hides (F9).
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/progress.h"
#include "field/merge/merge_fields.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A part hides points that are deeper inside it than this [voxel]; coinciding surfaces are kept.
inline constexpr double kHiddenFrom = 0.02;

// Returns a reader for each part's field.
std::deque<NodeReader> nodesOf(std::span<const FieldPart> parts);

// Returns true if a point of part `owner` is hidden; `nodes` read the parts' fields. q is in grid
// coordinates of the lattice.
bool isHidden(std::span<const FieldPart> parts, const std::deque<NodeReader>& nodes,
              std::int32_t owner, const Vec3& q);

struct UnionSurface {
  TriangleMesh mesh;              // corners are not shared
  std::vector<std::int32_t> face; // face in the combined mesh of each triangle
};

// Cuts triangles where they enter another part, with an error of O(h^2): in pieces of at most a
// voxel, each cut straight. `joint` holds the parts' meshes one after another, in the world;
// degenerate and non-finite triangles are left out. Parallel; polls `progress` and throws
// Cancelled.
UnionSurface unionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                          const TriangleMesh& joint, const Progress& progress);

// Returns unionSurface() with the caps, which are the backs and sides of thickened sheets.
UnionSurface closedUnionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                                const TriangleMesh& joint, const Progress& progress);

} // namespace patina
