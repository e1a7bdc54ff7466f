// Painted material in one object's pose, as plain data for kernels of any instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace patina {

struct MaterialView {
  // Node coordinates from the world [m]: [0] x + [1] y + [2] z + [3]; the last lane is 0.
  double node_of_world[4][4];
  double count[4];       // nodes along each axis; 1 in the last lane
  double by_world[3][4]; // derivatives of the node coordinates by x, y and z [1/m]
  const std::int32_t* block_index;
  const double* const* nodes;          // first value of each slot
  std::int32_t block_step[4], step[4]; // strides along each axis: in block_index; in a block
  struct Channel {
    std::int32_t value;    // index in Material
    std::int32_t gradient; // 0 or 1; -1: not needed
  };
  static constexpr std::size_t kMaxChannels = 5; // kMaterialChannels
  std::size_t channels;
  Channel channel[kMaxChannels];
};

// Evaluates at p [m, world]: writes values of channels to `material`, and {by x, by y, by z} of the
// requested ones to gradients[0] and [1]. Writes nothing where the base applies.
using MaterialKernel = void (*)(const MaterialView& view, const double* p, double* material,
                                double* const* gradients) noexcept;

} // namespace patina
