// Regular grid of a field.
#pragma once

#include <array>
#include <optional>

#include "core/types.h"
#include "geometry/sides/open_parts.h"

namespace patina {

inline constexpr int kMaxNodes = 4096; // a side

// Node (i, j, k) lies at origin + voxel * (i, j, k). "Grid coordinates" of p: (p - origin) / voxel.
struct FieldGrid {
  Vec3 origin = Vec3::Zero(); // [m]
  double voxel = 0;           // h [m]
  std::array<int, 3> nodes{}; // nodes along x, y, z; a cell lies between two nodes

  Vec3 toGrid(const Vec3& p) const { return (p - origin) / voxel; }
  Vec3 toWorld(const Vec3& q) const { return origin + voxel * q; }
  std::size_t nodeCount() const {
    return static_cast<std::size_t>(nodes[0]) * static_cast<std::size_t>(nodes[1]) *
           static_cast<std::size_t>(nodes[2]);
  }
};

struct FieldSpec {
  int resolution = 150;        // cells along the longest side, band included on both ends
  std::optional<double> voxel; // [m]; replaces the resolution
  double band = 8;             // voxels on each side of the surface in which nodes are stored
  OpenSides sides = OpenSides::automatic; // sides of the mesh's parts with a boundary
};

// Returns `spec` with its band widened, if necessary, by `reach` [m] and `margin` voxels. The
// resolution is unchanged, so that a wider band makes larger voxels.
FieldSpec widened(const FieldSpec& spec, const Box3& box, double reach, double margin);

// Returns the grid of a box grown by the band on each side. At resolution N: h = longest / (N - 2
// band). Throws Error if N <= 2 band + 2, if the voxel is not positive, or beyond 4096 nodes a
// side.
FieldGrid gridAround(const Box3& box, const FieldSpec& spec);

} // namespace patina
