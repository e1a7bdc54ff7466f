// The sampled implicit surface (K01): signed distance in a narrow band, stored in sparse 8^3 blocks
// under a dense top table. Immutable once built; blocks are shared between versions
// (copy-on-write).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/types.h"
#include "field/store/face_block.h"
#include "field/store/field_grid.h"
#include "field/store/packed_distance.h"

namespace patina {

// What the servo reads: one block look-up serves any point of its 8^3 cells. The 9^3 nodes are
// those of the block and the first layer of its upper neighbours; each holds phi and the nodal
// gradient (K04: central differences; of its own side beside a crease, one-sided beside a node
// beyond the band; dimensionless, |g| about 1). Nodes beyond the band hold +-kBeyondBand and a zero
// gradient. Derived from the distance layer.
struct alignas(16) SampleNode {
  float phi, gx, gy, gz;
};
inline constexpr int kSampleSide = kBlockSide + 1;
struct SampleBlock {
  std::array<SampleNode, kSampleSide * kSampleSide * kSampleSide> node; // x fastest
  std::array<std::uint64_t, kBlockSide>
      complete; // [z], bit 8 y + x: all 8 nodes of the cell stored

  bool cellComplete(int x, int y, int z) const {
    return complete[static_cast<std::size_t>(z)] >> (kBlockSide * y + x) & 1;
  }
};

// Distance at every block corner, 8 voxels apart, in voxels: what contact deeper than the band
// reads (flagged, never zero force), and where the field is clearly in or out.
struct CoarseNode {
  float phi, gx, gy, gz;
};

struct LayerBytes {
  std::string name; // "top", "distance", "face", "sample", "coarse"
  std::size_t bytes = 0;
};

// Plain data with invariants kept by its makers (buildField, sampleFunction, and later edits).
struct SurfaceField {
  static constexpr std::int32_t kOutside = -1; // top-table values of blocks that are not stored
  static constexpr std::int32_t kInside = -2;

  FieldGrid grid;
  double band = 8;               // voxels
  std::array<int, 3> blocks{};   // blocks along x, y, z
  std::vector<std::int32_t> top; // slot of each block (x fastest), or kOutside / kInside
  std::vector<std::array<std::int32_t, 3>> block_at;          // slot -> block coordinates
  std::vector<std::shared_ptr<const DistanceBlock>> distance; // by slot
  std::vector<std::shared_ptr<const FaceBlock>> face;         // by slot; empty if no mesh
  std::vector<std::shared_ptr<const SampleBlock>> sample;     // by slot; empty until withSamples()
  std::vector<CoarseNode> coarse; // (blocks + 1) per axis, x fastest; empty if not asked for

  std::size_t blockCount() const { return block_at.size(); }
  std::int32_t slotOf(int bx, int by, int bz) const {
    return top[static_cast<std::size_t>((bz * blocks[1] + by) * blocks[0] + bx)];
  }
  // Where a node is held: slot and index in its block; slot < 0 where none is, kOutside outside the
  // grid.
  struct Place {
    std::int32_t slot;
    std::size_t index;
  };
  Place placeOf(int i, int j, int k) const;
  // -1 outside the grid or in a block that is not stored. Distances are read by NodeReader.
  std::int32_t faceAt(int i, int j, int k) const;
  std::vector<LayerBytes> layerBytes() const; // only layers that exist
  std::size_t bytes() const;
};

// phi of a block that is not stored, by its value in the top table.
inline float phiBeyond(std::int32_t slot) {
  return slot == SurfaceField::kInside ? -kBeyondBand : kBeyondBand;
}

// Adds the layer that samplers read. Idempotent; shares all other blocks with `field`.
std::shared_ptr<const SurfaceField> withSamples(std::shared_ptr<const SurfaceField> field);

// A field of an analytic signed distance [m] (no face layer), for studies and tests. phi must be
// 1-Lipschitz; blocks that it proves to be out of the band are never visited.
SurfaceField sampleFunction(const std::function<double(const Vec3&)>& phi, const FieldGrid& grid,
                            double band);

} // namespace patina
