// The nearest faces of a block's nodes (K02), held small: neighbouring nodes mostly share a face.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace patina {

inline constexpr int kBlockSide = 8;                                     // nodes
inline constexpr int kBlockNodes = kBlockSide * kBlockSide * kBlockSide; // 512, x fastest

// While a field is being made: one face a node, -1 where phi is beyond the band.
struct FaceNodes {
  std::array<std::int32_t, kBlockNodes> face;
};

// The same, immutable: up to 256 different faces are listed once and named by a byte a node; more
// are held as they are. Either way at() is two look-ups.
class FaceBlock {
 public:
  explicit FaceBlock(const FaceNodes& nodes);
  // The same with `offset` added to every face but -1: faces of one mesh among those of several.
  FaceBlock(const FaceBlock& block, std::int32_t offset);

  std::int32_t at(std::size_t node) const {
    return code_.empty() ? faces_[node] : faces_[code_[node]];
  }
  std::size_t bytes() const {
    return sizeof(*this) + faces_.capacity() * sizeof(std::int32_t) + code_.capacity();
  }

 private:
  std::vector<std::int32_t> faces_; // different ones, or all 512
  std::vector<std::uint8_t> code_;  // empty, or 512
};

} // namespace patina
