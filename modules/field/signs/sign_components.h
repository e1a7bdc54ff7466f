// Nodes that the surface cannot separate, as connected components: private to signs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/build/field_builder.h"

namespace patina::signs {

// d1 + d2 must exceed the length between two nodes by this [voxel]. Above what both distances err,
// it keeps components from leaking through cracks: midway in one of half-width c, d is c and not 0.
inline constexpr float kMargin = 0.02F;

// The nodes of one block that are connected inside it, or one whole block that is not stored.
struct Part {
  std::int32_t slot = -1;    // -1 = not stored
  std::uint16_t deepest = 0; // node of the block, by index
  std::uint16_t nodes = 0;
  float depth = 0; // unsigned distance at `deepest`, at most band + 1; 0 if not stored
};

struct Link { // `edges` grid edges connect parts a and b of different blocks
  std::uint32_t a, b, edges;
};

using Labels = std::array<std::uint16_t, kBlockNodes>;

struct Components {
  std::vector<Part> parts; // by slot, then one for each entry of the top table, used or not
  std::vector<std::uint32_t> first;            // slot -> its first part; one entry past the end
  std::vector<std::unique_ptr<Labels>> labels; // by slot: node -> part - first; null if all 0
  std::vector<Link> links;                     // but those between blocks that are not stored
  std::vector<std::uint32_t> root;             // part -> lowest part of its component

  std::uint32_t partOf(std::int32_t slot, std::size_t node) const {
    const auto s = static_cast<std::size_t>(slot);
    return first[s] + (labels[s] ? (*labels[s])[node] : 0U);
  }
  std::uint32_t partOfBlock(std::size_t top_index) const {
    return first.back() + static_cast<std::uint32_t>(top_index);
  }
};

Components connectedComponents(const FieldBuilder& builder);
// By far the most links, 36 bytes a block of the grid, and needed only where a surface leaks.
void linkUnstored(const FieldBuilder& builder, Components& components);

} // namespace patina::signs
