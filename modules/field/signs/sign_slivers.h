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

// Finds one of the 26 neighbours that is farther from the surface and on the same side, by the sum
// of distances or because no triangle lies between them. Returns false if there is none.
bool visibleDeeperNode(const FieldBuilder& builder, const TriangleTree& tree, std::int32_t slot,
                       std::size_t node, NodePlace& found);

} // namespace patina::signs
