// Sampled implicit surface (K01): signed distance in a narrow band, in sparse 8^3 blocks under a
// dense block index. Immutable once built; versions share blocks (copy-on-write).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/types.h"
#include "field/store/face_block.h"
#include "field/store/field_grid.h"

namespace patina {

// Distance at nodes outside the band, with the sign of their side [voxel].
inline constexpr float kBackground = 1e6f;

// Signed distance in voxels, independent of the scale, negative inside; finite. A node beyond the
// band holds +-kBackground with the right sign; one that relief moved out of the band keeps its
// value.
struct DistanceNodes {
  std::array<float, kBlockNodes> phi;
};

// Distances of a block's nodes, compressed by predicting each row from the rows before it: a
// lossless, immutable code of the differences from the prediction, four nodes at a time with as
// many bits as the largest needs. Unpacking takes half a microsecond; NodeReader keeps unpacked
// blocks.
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

  std::array<std::uint8_t, kRows> held_;    // a bit for each node other than fill_
  std::array<std::uint8_t, kRows> level_{}; // code width of each four nodes
  std::unique_ptr<std::uint32_t[]> data_;
  std::uint32_t words_ = 0;
  float fill_; // kBackground or -kBackground, the more frequent one
};

// Sample layer for the servo, derived from the distances: one block look-up serves any point of its
// 8^3 cells. The 9^3 nodes are those of the block and the first layer of its upper neighbours. Each
// holds phi and the nodal gradient (K04: central differences; one-sided beside a crease or a node
// beyond the band; dimensionless, |g| about 1). Nodes beyond the band hold +-kBackground and a zero
// gradient.
struct alignas(16) SampleNode {
  float phi, gx, gy, gz;
};
inline constexpr int kSampleSide = kBlockSide + 1;
struct SampleBlock {
  std::array<SampleNode, kSampleSide * kSampleSide * kSampleSide> node; // x fastest
  std::array<std::uint64_t, kBlockSide>
      complete; // [z], bit 8 y + x: all 8 nodes of the cell are stored

  bool cellComplete(int x, int y, int z) const {
    return complete[static_cast<std::size_t>(z)] >> (kBlockSide * y + x) & 1;
  }
};

// Distance in voxels at every block corner, 8 voxels apart. Contact deeper than the band reads it
// (flagged, never with zero force), and it separates inside from outside.
struct CoarseNode {
  float phi, gx, gy, gz;
};

struct LayerBytes {
  std::string name; // "top", "distance", "face", "sample", "coarse"
  std::size_t bytes = 0;
};

// Plain data whose makers (buildField, sampleFunction, edits) keep its invariants.
struct SurfaceField {
  static constexpr std::int32_t kOutside = -1; // block index of unstored blocks
  static constexpr std::int32_t kInside = -2;

  FieldGrid grid;
  double band = 8;                       // voxels
  std::array<int, 3> blocks{};           // blocks along x, y, z
  std::vector<std::int32_t> block_index; // slot of each block (x fastest), or kOutside / kInside
  std::vector<std::array<std::int32_t, 3>> block_at;          // block coordinates of each slot
  std::vector<std::shared_ptr<const DistanceBlock>> distance; // per slot
  std::vector<std::shared_ptr<const FaceBlock>> face;         // per slot; empty without a mesh
  std::vector<std::shared_ptr<const SampleBlock>> sample;     // per slot; empty until withSamples()
  std::vector<CoarseNode> coarse; // (blocks + 1) per axis, x fastest; empty if not requested

  std::size_t blockCount() const { return block_at.size(); }
  std::int32_t slotOf(int bx, int by, int bz) const {
    return block_index[static_cast<std::size_t>((bz * blocks[1] + by) * blocks[0] + bx)];
  }
  // Address of a node: slot and index in its block. slot < 0: not stored; kOutside: outside the
  // grid.
  struct NodeAddress {
    std::int32_t slot;
    std::size_t index;
  };
  NodeAddress placeOf(int i, int j, int k) const;
  // Returns -1 outside the grid or in an unstored block. NodeReader reads the distances.
  std::int32_t faceAt(int i, int j, int k) const;
  std::vector<LayerBytes> layerBytes() const; // existing layers only
  std::size_t bytes() const;
};

// Returns phi of an unstored block from its value in the block index.
inline float backgroundOf(std::int32_t slot) {
  return slot == SurfaceField::kInside ? -kBackground : kBackground;
}

// Adds the sample layer. Idempotent; shares all other blocks with `field`.
std::shared_ptr<const SurfaceField> withSamples(std::shared_ptr<const SurfaceField> field);

// Samples an analytic signed distance [m] (no face layer), for studies and tests. phi must be
// 1-Lipschitz, which allows blocks outside the band to be skipped.
SurfaceField sampleFunction(const std::function<double(const Vec3&)>& phi, const FieldGrid& grid,
                            double band);

} // namespace patina
