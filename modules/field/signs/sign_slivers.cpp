#include "field/signs/sign_slivers.h"

#include <algorithm>
#include <cmath>

#include "field/signs/sign_components.h"

namespace patina::signs {
float NearbyBlocks::distanceAt(std::int32_t slot, std::size_t node) {
  std::size_t i = 0;
  while (i < count_ && slots_[i] != slot) ++i;
  if (i == count_) {
    i = count_ < slots_.size() ? count_++ : next_++ % slots_.size();
    slots_[i] = slot;
    phi_[i] = phiOf(builder_, static_cast<std::size_t>(slot));
  }
  return std::abs(phi_[i][node]);
}

std::array<int, 3> nodeAt(const FieldBuilder& builder, std::int32_t slot, std::size_t node) {
  return BlockNode{builder.field.block_at[static_cast<std::size_t>(slot)], node}.at();
}

bool visibleDeeperNode(NearbyBlocks& blocks, const TriangleTree& tree, std::int32_t slot,
                       std::size_t node, NodePlace& found, float gap) {
  struct Candidate {
    NodePlace place;
    std::array<int, 3> step;
    float margin; // excess of the distances over the length
  };
  std::array<Candidate, 26> candidates;
  std::size_t count = 0;
  const FieldBuilder& builder = blocks.builder();
  const SurfaceField& field = builder.field;
  const float depth = blocks.distanceAt(slot, node);
  const std::array<int, 3> at = nodeAt(builder, slot, node);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = at[0] + dx, y = at[1] + dy, z = at[2] + dz;
        if (x < 0 || y < 0 || z < 0) continue;
        const BlockNode next = BlockNode::of(Index3{x, y, z});
        const auto& [bx, by, bz] = next.block;
        if (bx >= field.blocks[0] || by >= field.blocks[1] || bz >= field.blocks[2]) continue;
        NodePlace place;
        place.top_index =
            static_cast<std::size_t>((bz * field.blocks[1] + by) * field.blocks[0] + bx);
        place.slot = std::max(field.block_index[place.top_index], -1);
        place.node = next.node;
        const float d = place.slot < 0 ? static_cast<float>(field.band)
                                       : blocks.distanceAt(place.slot, place.node);
        if (d <= depth) continue;
        constexpr std::array<float, 4> kLength{0, 1, 1.41421356F, 1.73205081F};
        const float margin =
            depth + d - kLength[static_cast<std::size_t>(dx * dx + dy * dy + dz * dz)];
        if (margin > gap) {
          found = place;
          return true;
        }
        candidates[count++] = {place, {dx, dy, dz}, margin};
      }
    }
  }
  // Tries the most likely ones first; more rays would cost as much as the winding number.
  constexpr std::size_t kRays = 4;
  const Vec3 origin = field.grid.toWorld(Vec3(at[0], at[1], at[2]));
  for (std::size_t i = 0; i < std::min(count, kRays); ++i) {
    const auto left = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    const auto best = std::max_element(
        left, candidates.begin() + static_cast<std::ptrdiff_t>(count),
        [](const Candidate& a, const Candidate& b) { return a.margin < b.margin; });
    std::swap(*left, *best);
    if (left->margin > kExact) {
      found = left->place;
      return true;
    }
    const Vec3 step(left->step[0], left->step[1], left->step[2]);
    if (tree.firstHit(origin, step, step.norm() * field.grid.voxel)) continue;
    found = left->place;
    return true;
  }
  return false;
}

} // namespace patina::signs
