// Nearest faces of a block's nodes (K02), run-length coded.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>

#include "field/store/block_node.h"

namespace patina {

// Used while a field is built: one face per node, -1 beyond the band.
struct FaceNodes {
  std::array<std::int32_t, kBlockNodes> face;
};

// Immutable run-length code. A serpentine path through the block along the best axis keeps each
// face for several nodes, because the nearest face changes little along its normal. Each run refers
// to a table of the block's faces. at() takes constant time.
class FaceBlock {
 public:
  explicit FaceBlock(const FaceNodes& nodes);
  // The same with `offset` added to every face but -1, for the combined mesh.
  FaceBlock(const FaceBlock& block, std::int32_t offset);

  std::int32_t at(std::size_t node) const {
    const std::size_t step = stepOf(node, axis_order_);
    std::size_t run = static_cast<std::size_t>(
        std::popcount(starts_[step / 64] << (63 - step % 64))); // at least one run starts earlier
    for (std::size_t word = 0; word < step / 64; ++word)
      run += static_cast<std::size_t>(std::popcount(starts_[word]));
    return face(code(run - 1));
  }
  std::size_t bytes() const { return sizeof(*this) + dataBytes(); }

 private:
  // Returns the position of a node on the path with the given axis order.
  static std::size_t stepOf(std::size_t node, std::uint32_t axis_order) {
    const std::size_t a = node >> (axis_order & 15U) & 7U, b = node >> (axis_order >> 4 & 7U) & 7U;
    // The third shift completes the sum 0 + 3 + 6.
    const std::size_t c = node >> (9U - (axis_order & 15U) - (axis_order >> 4 & 7U)) & 7U;
    const std::size_t row = c & 1U ? 7U - b : b;
    return 64 * c + 8 * row + (row & 1U ? 7U - a : a);
  }
  std::size_t faceBytes() const { return wide_ ? 4 : 2; }
  std::size_t dataBytes() const {
    return std::size_t{faces_} * faceBytes() + (std::size_t{runs_} * bits_ + 7) / 8 +
           (bits_ > 0 ? 1 : 0);
  }
  std::size_t code(std::size_t run) const {
    if (bits_ == 0) return 0;
    const std::size_t bit = run * bits_;
    const std::uint8_t* at = data_.get() + faces_ * faceBytes() + bit / 8;
    return (static_cast<std::size_t>(at[0]) | static_cast<std::size_t>(at[1]) << 8) >> bit % 8 &
           ((std::size_t{1} << bits_) - 1);
  }
  std::int32_t face(std::size_t code) const;

  std::array<std::uint64_t, kBlockNodes / 64> starts_{}; // bit i: a run begins at step i
  std::unique_ptr<std::uint8_t[]> data_; // table of faces minus lowest_, then a code per run
  std::int32_t lowest_ = 0;
  std::uint32_t faces_ : 10 = 0, runs_ : 10 = 0;
  std::uint32_t bits_ : 4 = 0;       // bits of a code, at most 9
  std::uint32_t axis_order_ : 7 = 0; // shifts of a node's index for its first two axes
  std::uint32_t wide_ : 1 = 0;       // faces take four bytes instead of two
};

} // namespace patina
