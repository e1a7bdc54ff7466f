// Painted material as one object's pose sees it, plain enough for a kernel of any instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace patina {

struct MaterialView {
  // Nodes of the table by world [m]: [0] x + [1] y + [2] z + [3]; the last lane is 0.
  double node_of_world[4][4];
  double count[4];       // nodes along each axis; 1 in the last lane
  double by_world[3][4]; // how each of the three grows along x, y and z [1/m]
  const std::int32_t* top;
  const double* const* nodes;          // of each slot
  std::int32_t block_step[4], step[4]; // along each axis: of `top`; of a block's numbers
  struct Channel {
    std::int32_t value;    // which of Material's numbers it is
    std::int32_t gradient; // 0 or 1; -1: nobody asks
  };
  static constexpr std::size_t kMost = 5; // kMaterialChannels
  std::size_t channels;
  Channel channel[kMost];
};

// At p [m, world]: values of channels into `material`, {by x, by y, by z} of those that are asked
// for into gradients[0] and [1]. Nothing where it is the base.
using MaterialLook = void (*)(const MaterialView& view, const double* p, double* material,
                              double* const* gradients) noexcept;

} // namespace patina
