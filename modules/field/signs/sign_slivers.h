// Components so close to the surface that hardly any edge about them is safe: private to signs.
#pragma once

#include <array>
#include <cstdint>

#include "field/build/field_builder.h"
#include "geometry/tree/triangle_tree.h"

namespace patina::signs {

struct NodePlace {
  std::int32_t slot = -1; // -1 = in the unstored block `top_index`
  std::size_t node = 0;
  std::size_t top_index = 0;
};

std::array<int, 3> nodeAt(const FieldBuilder& builder, std::int32_t slot, std::size_t node);

// A node of the 26 about this one that is farther from the surface and on the same side: because
// the sum of distances says so, or else because no triangle lies between them. False if none.
bool visibleDeeperNode(const FieldBuilder& builder, const TriangleTree& tree, std::int32_t slot,
                       std::size_t node, NodePlace& found);

} // namespace patina::signs
