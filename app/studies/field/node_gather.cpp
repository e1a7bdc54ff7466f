#include "app/studies/field/node_gather.h"

#include <algorithm>

namespace patina {

DenseNodes denseNodes(const SurfaceField& field) {
  DenseNodes nodes;
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    nodes.size[axis] = field.blocks[axis] * kBlockSide;
    count *= static_cast<std::size_t>(nodes.size[axis]);
  }
  nodes.phi.resize(count);
  DistanceNodes block;
  for (int bz = 0; bz < field.blocks[2]; ++bz)
    for (int by = 0; by < field.blocks[1]; ++by)
      for (int bx = 0; bx < field.blocks[0]; ++bx) {
        const std::int32_t slot = field.slotOf(bx, by, bz);
        if (slot < 0)
          block.phi.fill(phiBeyond(slot));
        else
          field.distance[static_cast<std::size_t>(slot)]->unpack(block);
        for (int z = 0; z < kBlockSide; ++z)
          for (int y = 0; y < kBlockSide; ++y)
            std::copy_n(
                &block.phi[static_cast<std::size_t>((z * kBlockSide + y) * kBlockSide)], kBlockSide,
                &nodes.phi[nodes.index(bx * kBlockSide, by * kBlockSide + y, bz * kBlockSide + z)]);
      }
  return nodes;
}

std::vector<float> gatherBlocks(const SurfaceField& field, const DenseNodes& nodes, int first,
                                int side) {
  std::vector<float> gathered;
  gathered.reserve(field.blockCount() * static_cast<std::size_t>(side * side * side) + 4);
  const auto inside = [&](int i, std::size_t axis) { return i >= 0 && i < nodes.size[axis]; };
  for (const std::array<int, 3>& at : field.block_at)
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const int i = at[0] * kBlockSide + first + x, j = at[1] * kBlockSide + first + y,
                    k = at[2] * kBlockSide + first + z;
          gathered.push_back(inside(i, 0) && inside(j, 1) && inside(k, 2)
                                 ? nodes.phi[nodes.index(i, j, k)]
                                 : kBeyondBand);
        }
  return gathered;
}

} // namespace patina
