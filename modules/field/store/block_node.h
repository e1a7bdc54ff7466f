// Address of a node of a sparse grid: block and index.
#pragma once

#include <array>
#include <cstddef>

namespace patina {

using Index3 = std::array<int, 3>;

inline constexpr int kBlockSide = 8;                                     // nodes
inline constexpr int kBlockNodes = kBlockSide * kBlockSide * kBlockSide; // 512, x fastest

// Block (b) holds the nodes 8 b to 8 b + 7 along each axis, also below zero.
struct BlockNode {
  Index3 block;
  std::size_t node; // index in the block

  template <class Integer>
  static constexpr BlockNode of(const std::array<Integer, 3>& at) noexcept {
    constexpr Integer kIn = kBlockSide - 1;
    return {
        {static_cast<int>(at[0] >> 3), static_cast<int>(at[1] >> 3), static_cast<int>(at[2] >> 3)},
        static_cast<std::size_t>(((at[2] & kIn) * kBlockSide + (at[1] & kIn)) * kBlockSide +
                                 (at[0] & kIn))};
  }
  constexpr Index3 at() const noexcept {
    const int n = static_cast<int>(node);
    return {kBlockSide * block[0] + n % kBlockSide,
            kBlockSide * block[1] + n / kBlockSide % kBlockSide,
            kBlockSide * block[2] + n / (kBlockSide * kBlockSide)};
  }
};

} // namespace patina
