#include "field/store/block_lattice.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"
#include "field/store/face_block.h"

namespace patina {
namespace {

int blockOf(double node) {
  return static_cast<int>(std::floor(node / kBlockSide));
}

} // namespace

void BlockBox::extend(const BlockBox& other) {
  if (other.isEmpty()) return;
  if (isEmpty()) {
    *this = other;
    return;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], other.low[a]);
    high[a] = std::max(high[a], other.high[a]);
  }
}

BlockBox blocksAround(const BlockLattice& lattice, const Box3& box, double band) {
  constexpr double kSlack = 1e-6; // absorbs the division's rounding
  BlockBox blocks;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double low = (box.min()[axis] - lattice.anchor[axis]) / lattice.voxel - band;
    const double high = (box.max()[axis] - lattice.anchor[axis]) / lattice.voxel + band;
    if (!(high - low < kMostNodes && std::abs(low) < 1e9))
      throw Error("field: an object needs " + formatNumber(std::ceil(high - low)) + " voxels of " +
                  formatLength(lattice.voxel) + " on a side; the most is " +
                  std::to_string(kMostNodes - 1) + "; choose a larger voxel");
    blocks.low[a] = blockOf(std::floor(low + kSlack));
    blocks.high[a] = blockOf(std::ceil(high - kSlack)) + 1;
  }
  return blocks;
}

FieldGrid gridOf(const BlockLattice& lattice, const BlockBox& blocks) {
  FieldGrid grid;
  grid.voxel = lattice.voxel;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    grid.origin[axis] = lattice.anchor[axis] + lattice.voxel * kBlockSide * blocks.low[a];
    grid.nodes[a] = kBlockSide * (blocks.high[a] - blocks.low[a]);
    if (grid.nodes[a] > kMostNodes)
      throw Error("field: the scene needs " + std::to_string(grid.nodes[a]) + " voxels of " +
                  formatLength(lattice.voxel) + " on a side; the most is " +
                  std::to_string(kMostNodes) + "; choose a larger voxel or move objects closer");
  }
  return grid;
}

std::array<int, 3> firstBlock(const BlockLattice& lattice, const FieldGrid& grid) {
  std::array<int, 3> first{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    first[a] = static_cast<int>(
        std::lround((grid.origin[axis] - lattice.anchor[axis]) / (kBlockSide * lattice.voxel)));
  }
  return first;
}

} // namespace patina
