#include "field/surface_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace patina {
namespace {

// Slot and index inside the block of a node; slot < 0 outside.
struct NodePlace {
  std::int32_t slot;
  std::size_t index;
};

NodePlace placeOf(const SurfaceField& field, int i, int j, int k) {
  const auto& n = field.grid.nodes;
  if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2])
    return {SurfaceField::kOutside, 0};
  const int mask = kBlockSide - 1;
  return {
      field.slotOf(i / kBlockSide, j / kBlockSide, k / kBlockSide),
      static_cast<std::size_t>(((k & mask) * kBlockSide + (j & mask)) * kBlockSide + (i & mask))};
}

// phi of a block's nodes and of one layer around them.
constexpr int kPadded = kBlockSide + 3; // nodes -1 .. 9: the 9^3 samples and both their neighbours
using PaddedPhi = std::array<float, kPadded * kPadded * kPadded>;

constexpr std::size_t paddedIndex(int x, int y, int z) {
  return static_cast<std::size_t>(((z + 1) * kPadded + (y + 1)) * kPadded + (x + 1));
}

// Nodes [first, last) of the padded range that lie in the neighbour at offset d, and the
// neighbour's own index of `first`.
struct Overlap {
  int first, last, source;
};
constexpr Overlap overlap(int d) {
  if (d < 0) return {-1, 0, kBlockSide - 1};
  if (d > 0) return {kBlockSide, kBlockSide + 2, 0};
  return {0, kBlockSide, 0};
}

void gatherNeighbour(const SurfaceField& field, const std::array<int, 3>& at, int dx, int dy,
                     int dz, PaddedPhi& padded) {
  const int bx = at[0] + dx, by = at[1] + dy, bz = at[2] + dz;
  const bool inside_grid = bx >= 0 && by >= 0 && bz >= 0 && bx < field.blocks[0] &&
                           by < field.blocks[1] && bz < field.blocks[2];
  const std::int32_t slot = inside_grid ? field.slotOf(bx, by, bz) : SurfaceField::kOutside;
  const float fill = slot == SurfaceField::kInside ? -kBeyondBand : kBeyondBand;
  const float* phi =
      slot >= 0 ? field.distance[static_cast<std::size_t>(slot)]->phi.data() : nullptr;
  const Overlap ox = overlap(dx), oy = overlap(dy), oz = overlap(dz);
  for (int z = oz.first; z < oz.last; ++z)
    for (int y = oy.first; y < oy.last; ++y) {
      float* row = &padded[paddedIndex(ox.first, y, z)];
      const int length = ox.last - ox.first;
      if (!phi) {
        std::fill_n(row, length, fill);
        continue;
      }
      const int row_source =
          ((oz.source + z - oz.first) * kBlockSide + oy.source + y - oy.first) * kBlockSide +
          ox.source;
      std::memcpy(row, phi + row_source, static_cast<std::size_t>(length) * sizeof(float));
    }
}

// K04: central where both neighbours are stored, one-sided where one is, zero where none is.
float difference(float before, float here, float after) {
  const bool has_before = std::abs(before) < kBeyondBand, has_after = std::abs(after) < kBeyondBand;
  const float low = has_before ? before : here, high = has_after ? after : here;
  return (high - low) * (has_before && has_after ? 0.5F : 1.0F);
}

void fillNodes(const PaddedPhi& padded, SampleBlock& block) {
  SampleNode* out = block.node.data();
  for (int z = 0; z < kSampleSide; ++z)
    for (int y = 0; y < kSampleSide; ++y) {
      const float* here = &padded[paddedIndex(0, y, z)];
      for (int x = 0; x < kSampleSide; ++x, ++here, ++out) {
        if (!(std::abs(*here) < kBeyondBand)) {
          *out = {*here, 0, 0, 0};
          continue;
        }
        *out = {*here, difference(here[-1], *here, here[1]),
                difference(here[-kPadded], *here, here[kPadded]),
                difference(here[-kPadded * kPadded], *here, here[kPadded * kPadded])};
      }
    }
}

// Cell flags by AND-ing rows of node flags along x, then y, then z.
void fillComplete(const PaddedPhi& padded, SampleBlock& block) {
  std::array<std::uint64_t, kSampleSide> layer{};
  for (int z = 0; z < kSampleSide; ++z) {
    unsigned previous = 0;
    std::uint64_t cells = 0;
    for (int y = 0; y < kSampleSide; ++y) {
      const float* row = &padded[paddedIndex(0, y, z)];
      unsigned stored = 0;
      for (int x = 0; x < kSampleSide; ++x)
        stored |= static_cast<unsigned>(std::abs(row[x]) < kBeyondBand) << x;
      const unsigned edges = stored & stored >> 1 & 0xFFU;
      if (y > 0) cells |= static_cast<std::uint64_t>(edges & previous) << (kBlockSide * (y - 1));
      previous = edges;
    }
    layer[static_cast<std::size_t>(z)] = cells;
  }
  for (std::size_t z = 0; z < kBlockSide; ++z) block.complete[z] = layer[z] & layer[z + 1];
}

std::shared_ptr<const SampleBlock> sampleBlock(const SurfaceField& field, std::size_t slot) {
  PaddedPhi padded;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        gatherNeighbour(field, field.block_at[slot], dx, dy, dz, padded);
  auto block = std::make_shared_for_overwrite<SampleBlock>();
  fillNodes(padded, *block);
  fillComplete(padded, *block);
  return block;
}

template <class Block>
std::size_t layerSize(const std::vector<std::shared_ptr<const Block>>& layer) {
  return layer.size() * (sizeof(Block) + sizeof(layer[0]));
}

std::size_t layerSize(const std::vector<std::shared_ptr<const FaceBlock>>& layer) {
  std::size_t sum = layer.size() * sizeof(layer[0]);
  for (const auto& block : layer) sum += block->bytes();
  return sum;
}

} // namespace

float SurfaceField::phiAt(int i, int j, int k) const {
  const NodePlace place = placeOf(*this, i, j, k);
  if (place.slot >= 0) return distance[static_cast<std::size_t>(place.slot)]->phi[place.index];
  return place.slot == kInside ? -kBeyondBand : kBeyondBand;
}

std::int32_t SurfaceField::faceAt(int i, int j, int k) const {
  const NodePlace place = placeOf(*this, i, j, k);
  if (place.slot < 0 || face.empty()) return -1;
  return face[static_cast<std::size_t>(place.slot)]->at(place.index);
}

std::vector<LayerBytes> SurfaceField::layerBytes() const {
  std::vector<LayerBytes> layers;
  const auto add = [&](const char* name, std::size_t size) {
    if (size > 0) layers.push_back({name, size});
  };
  add("top", top.size() * sizeof(top[0]) + block_at.size() * sizeof(block_at[0]));
  add("distance", layerSize(distance));
  add("face", layerSize(face));
  add("sample", layerSize(sample));
  add("coarse", coarse.size() * sizeof(CoarseNode));
  return layers;
}

std::size_t SurfaceField::bytes() const {
  std::size_t sum = 0;
  for (const LayerBytes& layer : layerBytes()) sum += layer.bytes;
  return sum;
}

std::shared_ptr<const SurfaceField> withSamples(std::shared_ptr<const SurfaceField> field) {
  if (field->sample.size() == field->blockCount()) return field;
  auto result = std::make_shared<SurfaceField>(*field);
  result->sample.resize(result->blockCount());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result->blockCount(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t slot = range.begin(); slot < range.end(); ++slot)
                        result->sample[slot] = sampleBlock(*field, slot);
                    });
  return result;
}

} // namespace patina
