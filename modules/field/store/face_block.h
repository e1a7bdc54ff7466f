// The nearest faces of a block's nodes (K02), held small: neighbouring nodes mostly share a face.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>

#include "field/store/block_node.h"

namespace patina {

// While a field is being made: one face a node, -1 where phi is beyond the band.
struct FaceNodes {
  std::array<std::int32_t, kBlockNodes> face;
};

// The same, immutable, as runs: a walk to and fro through the block, along the axis that serves
// best, meets a face several times in a row, for the nearest face changes little along its normal.
// Each run names one of the block's faces, which are listed once. at() is constant in time.
class FaceBlock {
 public:
  explicit FaceBlock(const FaceNodes& nodes);
  // The same with `offset` added to every face but -1: faces of one mesh among those of several.
  FaceBlock(const FaceBlock& block, std::int32_t offset);

  std::int32_t at(std::size_t node) const {
    const std::size_t step = stepOf(node, walk_);
    std::size_t run = static_cast<std::size_t>(
        std::popcount(starts_[step / 64] << (63 - step % 64))); // at least one before any other
    for (std::size_t word = 0; word < step / 64; ++word)
      run += static_cast<std::size_t>(std::popcount(starts_[word]));
    return face(code(run - 1));
  }
  std::size_t bytes() const { return sizeof(*this) + dataBytes(); }

 private:
  // Where the walk with the given order of axes meets a node.
  static std::size_t stepOf(std::size_t node, std::uint32_t walk) {
    const std::size_t a = node >> (walk & 15U) & 7U, b = node >> (walk >> 4 & 7U) & 7U;
    // The third shift: 0 + 3 + 6 in all.
    const std::size_t c = node >> (9U - (walk & 15U) - (walk >> 4 & 7U)) & 7U;
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

  std::array<std::uint64_t, kBlockNodes / 64> starts_{}; // by step of the walk: a run begins
  std::unique_ptr<std::uint8_t[]> data_;                 // faces less lowest_, then a code a run
  std::int32_t lowest_ = 0;
  std::uint32_t faces_ : 10 = 0, runs_ : 10 = 0;
  std::uint32_t bits_ : 4 = 0; // of a code, at most 9
  std::uint32_t walk_ : 7 = 0; // bits by which a node's index is shifted for its first two axes
  std::uint32_t wide_ : 1 = 0; // faces take four bytes instead of two
};

} // namespace patina
