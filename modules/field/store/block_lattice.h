// The lattice on which the fields of a scene's objects lie block upon block, so that they are
// merged without resampling (K14).
#pragma once

#include <array>

#include "field/store/field_grid.h"

namespace patina {

// Unbounded: node (0, 0, 0) at the anchor; block (b) holds the nodes 8 b .. 8 b + 7.
struct BlockLattice {
  Vec3 anchor = Vec3::Zero(); // [m]
  double voxel = 0;           // [m]
};

// Blocks low <= b < high.
struct BlockBox {
  std::array<int, 3> low{}, high{};

  bool isEmpty() const { return high[0] <= low[0]; }
  bool contains(const std::array<int, 3>& b) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (b[a] < low[a] || b[a] >= high[a]) return false;
    return true;
  }
  void extend(const BlockBox& other);
};

// The fewest blocks whose nodes reach `band` voxels past the box. Throws Error if they would be
// more than a grid may have.
BlockBox blocksAround(const BlockLattice& lattice, const Box3& box, double band);

// The grid of these blocks. Throws Error beyond 4096 nodes a side.
FieldGrid gridOf(const BlockLattice& lattice, const BlockBox& blocks);

// The lowest block of a grid on the lattice.
std::array<int, 3> firstBlock(const BlockLattice& lattice, const FieldGrid& grid);

} // namespace patina
