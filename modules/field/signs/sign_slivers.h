// Slivers: components too close to the surface for safe edges to others. Internal to the field.
#pragma once

#include <array>
#include <cstdint>

#include "field/store/field_builder.h"
#include "geometry/tree/triangle_tree.h"

namespace patina::signs {

struct NodePlace {
  std::int32_t slot = -1; // -1 = in the unstored block `top_index`
  std::size_t node = 0;
  std::size_t top_index = 0;
};

std::array<int, 3> nodeAt(const FieldBuilder& builder, std::int32_t slot, std::size_t node);

// Unsigned distances of the blocks about nodes, which are unpacked once while nodes nearby follow
// one another.
class NearbyBlocks {
 public:
  explicit NearbyBlocks(const FieldBuilder& builder) : builder_(builder) {}
  float distanceAt(std::int32_t slot, std::size_t node);
  const FieldBuilder& builder() const { return builder_; }

 private:
  const FieldBuilder& builder_;
  std::array<std::int32_t, 8> slots_; // A node and its neighbours lie in at most eight blocks.
  std::array<std::array<float, kBlockNodes>, 8> phi_;
  std::size_t count_ = 0, next_ = 0; // known blocks; calls that replaced one
};

// Excess [voxel] of the sum of two nodes' distances over the length between them that exceeds the
// errors of both. Cracks need no more, since a sliver joins nothing else.
inline constexpr float kExact = 1e-3F;

// Finds one of the 26 neighbours that is farther from the surface and on the same side, by the sum
// of distances or because no triangle lies between them. Returns false if there is none.
bool visibleDeeperNode(NearbyBlocks& blocks, const TriangleTree& tree, std::int32_t slot,
                       std::size_t node, NodePlace& found, float gap = kExact);

} // namespace patina::signs
