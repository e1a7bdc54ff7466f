#include "field/store/surface_field.h"

#include <algorithm>
#include <bit>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/store/four.h"
#include "field/store/node_reader.h"
#include "field/store/sample_block.h"

namespace patina {
namespace {

constexpr std::size_t kSide = kBlockSide, kAlongY = kSide, kAlongZ = kSide * kSide;
constexpr std::size_t kNodes = kBlockNodes;

// Calls visit(index, prediction) for each group of four nodes along x; visit stores their values.
// The Lorenzo predictor (Ibarria et al. 2003) uses earlier rows and not the last group. It only
// adds, so packing and unpacking give identical bits.
template <class Visit> void predictRows(const float* phi, const Visit& visit) {
  for (std::size_t x = 0; x < kSide; x += 4) visit(x, Float4{});
  for (std::size_t row = 1; row < kSide; ++row)
    for (const std::size_t step : {kAlongY, kAlongZ})
      for (std::size_t n = row * step; n < row * step + kSide; n += 4) {
        const Float4 last = load(phi + n - step);
        visit(n, row > 1 ? last + (last - load(phi + n - 2 * step)) : last);
      }
  for (std::size_t sum = 2; sum <= 2 * (kSide - 1); ++sum)
    for (std::size_t z = sum < kSide ? 1 : sum - (kSide - 1); z < std::min(sum, kSide); ++z) {
      const std::size_t first = z * kAlongZ + (sum - z) * kAlongY;
      for (std::size_t n = first; n < first + kSide; n += 4)
        visit(n, load(phi + n - kAlongY) +
                     (load(phi + n - kAlongZ) - load(phi + n - kAlongY - kAlongZ)));
    }
}

// Maps floats to integers of the same order, so that close ones differ in few low bits;
// self-inverse.
Word4 ordered(Word4 bits) {
  return bits ^ (-(bits >> 31)) >> 1;
}

// Maps small differences of either sign to small numbers (zigzag code).
Word4 folded(Word4 difference) {
  return difference << 1 ^ -(difference >> 31);
}

Word4 unfolded(Word4 code) {
  return code >> 1 ^ -(code & 1);
}

// Bit widths of the 16 levels: 0, 2 .. 28 and 32.
constexpr std::array<std::uint8_t, 16> kWidth = {0,  2,  4,  6,  8,  10, 12, 14,
                                                 16, 18, 20, 22, 24, 26, 28, 32};
constexpr std::array<std::uint32_t, 16> kMask = [] {
  std::array<std::uint32_t, 16> mask{};
  for (std::size_t level = 0; level < mask.size(); ++level)
    mask[level] = static_cast<std::uint32_t>((std::uint64_t{1} << kWidth[level]) - 1);
  return mask;
}();

std::uint32_t anyBits(Word4 four) {
  using Long2 = std::uint64_t __attribute__((vector_size(16)));
  const std::uint64_t bits = Long2(four | __builtin_shufflevector(four, four, 2, 3, 0, 1))[0];
  return static_cast<std::uint32_t>(bits | bits >> 32);
}

std::size_t levelFor(Word4 code) {
  const int width_and_one = std::bit_width(std::uint64_t{2} * anyBits(code) + 1);
  return static_cast<std::size_t>(std::min(width_and_one / 2, 15));
}

float commonerEnd(const DistanceNodes& nodes) {
  Int4 more_inside{};
  for (std::size_t n = 0; n < kNodes; n += 4) {
    const Float4 phi = load(&nodes.phi[n]);
    more_inside += (phi == kBackground) - (phi == -kBackground);
  }
  const int more = more_inside[0] + more_inside[1] + more_inside[2] + more_inside[3];
  return more > 0 ? -kBackground : kBackground;
}

} // namespace

DistanceBlock::DistanceBlock(const DistanceNodes& nodes) : fill_(commonerEnd(nodes)) {
  DistanceNodes met; // values that a reader reconstructs
  std::array<std::uint32_t, kNodes> code;
  predictRows(met.phi.data(), [&](std::size_t n, Float4 expected) {
    const Float4 phi = load(&nodes.phi[n]);
    const Float4 next = phi != fill_ ? phi : expected;
    store(next, &met.phi[n]);
    store(folded(ordered(Word4(next)) - ordered(Word4(expected))), &code[n]);
  });

  for (std::size_t row = 0; row < kRows; ++row) {
    const float* phi = &nodes.phi[row * kSide];
    const Int4 held = ((load(phi) != fill_) & Int4{1, 2, 4, 8}) |
                      ((load(phi + 4) != fill_) & Int4{16, 32, 64, 128});
    held_[row] = static_cast<std::uint8_t>(anyBits(Word4(held)));
  }

  std::array<std::uint32_t, kNodes + 8> data;
  std::size_t bit = 0;
  Word4 begun{}; // words that are not full yet
  for (std::size_t n = 0; n < kNodes; n += 4) {
    const Word4 next = load(&code[n]);
    const std::size_t level = levelFor(next);
    const unsigned shift = bit % 32;
    level_[n / kSide] |= static_cast<std::uint8_t>(level << n % kSide);
    begun |= next << shift;
    store(begun, &data[bit / 32 * 4]);
    bit += kWidth[level];
    const std::uint32_t full = 0U - (shift + kWidth[level]) / 32; // avoids a branch
    begun = (begun & ~full) | (next >> 1 >> (31 - shift) & full);
  }
  store(begun, &data[bit / 32 * 4]);
  words_ = static_cast<std::uint32_t>(4 * (bit / 32 + 2)); // readers load two groups at once
  data_ = std::make_unique<std::uint32_t[]>(words_);
  std::copy_n(data.begin(), words_ - 4, data_.get());
}

void DistanceBlock::unpack(DistanceNodes& nodes) const {
  float* const phi = nodes.phi.data();
  std::size_t bit = 0;
  for (std::size_t n = 0; n < kNodes; n += 4) {
    const std::size_t level = level_[n / kSide] >> n % kSide & 15U;
    const std::uint32_t* at = data_.get() + bit / 32 * 4;
    const unsigned shift = bit % 32;
    const Word4 code = (load(at) >> shift | load(at + 4) << 1 << (31 - shift)) & kMask[level];
    store(unfolded(code), phi + n);
    bit += kWidth[level];
  }
  predictRows(phi, [&](std::size_t n, Float4 expected) {
    store(ordered(ordered(Word4(expected)) + Word4(load(phi + n))), phi + n);
  });
  for (std::size_t row = 0; row < kRows; ++row) {
    if (held_[row] == 0xFF) continue;
    for (std::size_t n = row * kSide; n < (row + 1) * kSide; n += 4) {
      const Int4 is_held = (held_[row] >> n % kSide & Int4{1, 2, 4, 8}) != 0;
      const Float4 fill = {fill_, fill_, fill_, fill_};
      store(is_held ? load(phi + n) : fill, phi + n);
    }
  }
}

namespace {

template <class Block>
std::size_t layerSize(const std::vector<std::shared_ptr<const Block>>& layer) {
  std::size_t sum = 0;
  for (const auto& block : layer) sum += sizeof(block) + block->bytes();
  return sum;
}

} // namespace

SurfaceField::NodeAddress SurfaceField::placeOf(int i, int j, int k) const {
  const auto& n = grid.nodes;
  if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return {kOutside, 0};
  const auto [block, node] = BlockNode::of(Index3{i, j, k});
  return {slotOf(block[0], block[1], block[2]), node};
}

std::int32_t SurfaceField::faceAt(int i, int j, int k) const {
  const NodeAddress place = placeOf(i, j, k);
  if (place.slot < 0 || face.empty()) return -1;
  return face[static_cast<std::size_t>(place.slot)]->at(place.index);
}

std::vector<LayerBytes> SurfaceField::layerBytes() const {
  std::vector<LayerBytes> layers;
  const auto add = [&](const char* name, std::size_t size) {
    if (size > 0) layers.push_back({name, size});
  };
  add("top", block_index.size() * sizeof(block_index[0]) + block_at.size() * sizeof(block_at[0]));
  add("distance", layerSize(distance));
  add("face", layerSize(face));
  add("sample", sample.size() * (sizeof(SampleBlock) + sizeof(sample[0])));
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
  const NodeReader nodes(*field);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result->blockCount(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t slot = range.begin(); slot < range.end(); ++slot)
                        result->sample[slot] = sampleBlock(nodes, slot);
                    });
  return result;
}

} // namespace patina
