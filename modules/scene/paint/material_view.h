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
  std::size_t channels;
};

// {by x, by y, by z, value} of each channel at p [m, world] into `found`. False where it is the
// base.
using MaterialLook = bool (*)(const MaterialView& view, const double* p,
                              double (*found)[4]) noexcept;

} // namespace patina
