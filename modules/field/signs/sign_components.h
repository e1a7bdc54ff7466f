// Connected components of nodes on one side of the surface, and the cuts through those that leak.
// Internal to the field.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/store/field_builder.h"
#include "geometry/sides/open_parts.h"

namespace patina::signs {

// Excess [voxel] of d1 + d2 over the nodes' distance that connects them. Exceeds the errors of both
// and prevents leaks: midway in a crack of half-width c, d is c and not 0.
inline constexpr float kMargin = 0.02F;

// Nodes of one block that are connected inside it, or one whole unstored block.
struct Part {
  std::int32_t slot = -1;    // -1 = not stored
  std::uint16_t deepest = 0; // index of the deepest node in the block
  std::uint16_t nodes = 0;
  float depth = 0; // unsigned distance at `deepest`, at most band + 1; 0 if not stored
};

struct Link { // `edges` grid edges connect parts a and b of different blocks
  std::uint32_t a, b, edges;
};

using Labels = std::array<std::uint16_t, kBlockNodes>;

struct Components {
  std::vector<Part> parts;                     // sorted by slot, then one per entry of block_index
  std::vector<std::uint32_t> first;            // first part of each slot; one entry past the end
  std::vector<std::unique_ptr<Labels>> labels; // per slot: node -> part - first; null if all 0
  std::vector<Link> links;                     // links, except between unstored blocks
  std::vector<std::uint32_t> root;             // lowest part of each part's component

  std::uint32_t partOf(std::int32_t slot, std::size_t node) const {
    const auto s = static_cast<std::size_t>(slot);
    return first[s] + (labels[s] ? (*labels[s])[node] : 0U);
  }
  std::uint32_t partOfBlock(std::size_t top_index) const {
    return first.back() + static_cast<std::uint32_t>(top_index);
  }
};

Components connectedComponents(const FieldBuilder& builder, float margin = kMargin);
// Links unstored blocks: by far the most links (36 bytes per block), needed only for leaks.
void linkUnstored(const FieldBuilder& builder, Components& components);

// Cuts components that leak through holes of the surface. Internal to signs.

// Returns true if no edge of the closed parts has a single face, with equal vertices and duplicate
// faces merged. Then no component can run from inside to outside.
bool isClosed(const TriangleMesh& mesh, const OpenParts& open);

// Cuts leaking components so that few edges are crossed, by a random walk (Grady 2006) from each
// part along the links to the first part with an `inside_confidence`: 1 = certainly inside, -1 =
// certainly outside, 0 = none, NaN = not in a leaking component. Returns the sign of phi by part:
// -1 inside, +1 outside, 0 for others.
std::vector<std::int8_t> cutLeaks(const Components& components,
                                  const std::vector<float>& inside_confidence);

} // namespace patina::signs
