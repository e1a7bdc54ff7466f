// The distances of a block's nodes, held small: they are smooth, so that the rows before a row say
// most of what its nodes hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "field/store/face_block.h"

namespace patina {

inline constexpr float kBeyondBand = 1e6f;

// Signed distance in voxels (so that nothing depends on the scale), negative inside. A node farther
// than the band holds +-kBeyondBand with the right sign; one that relief moved out of it keeps its
// value. Finite.
struct DistanceNodes {
  std::array<float, kBlockNodes> phi;
};

// The same bit for bit, immutable: the differences of nodes from what the rows before their own
// lead to, four nodes at a time in as many bits as the greatest of them needs. Half a microsecond
// to unpack; NodeReader keeps what it has unpacked.
class DistanceBlock {
 public:
  explicit DistanceBlock(const DistanceNodes& nodes);

  void unpack(DistanceNodes& nodes) const;
  std::array<float, kBlockNodes> phi() const {
    DistanceNodes nodes;
    unpack(nodes);
    return nodes.phi;
  }

  std::size_t bytes() const { return sizeof(*this) + words_ * sizeof(data_[0]); }

 private:
  static constexpr std::size_t kRows = kBlockNodes / kBlockSide;

  std::array<std::uint8_t, kRows> held_;    // a bit for each node that is not fill_
  std::array<std::uint8_t, kRows> level_{}; // four bits for each four nodes: their codes' width
  std::unique_ptr<std::uint32_t[]> data_;
  std::uint32_t words_ = 0;
  float fill_; // kBeyondBand or -kBeyondBand, whichever more nodes hold
};

} // namespace patina
