#include "field/packed_distance.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace patina {
namespace {

constexpr int kAlongY = kBlockSide, kAlongZ = kBlockSide * kBlockSide;
constexpr std::size_t kFours = kBlockNodes / 4;

// Four nodes along x at once: the compiler's portable vectors, SSE or NEON alike.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Word4 = std::uint32_t __attribute__((vector_size(16)));

Float4 load(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

Word4 load(const std::uint32_t* from) {
  Word4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

template <class Four> void store(Four value, void* to) {
  std::memcpy(to, &value, sizeof(value));
}

// visit(index of the first, y, z) for all fours of nodes, each after those that it is expected from
// but away from them, so that none need wait for the last.
template <class Visit> void forFours(const Visit& visit) {
  for (int sum = 0; sum < 2 * kBlockSide - 1; ++sum)
    for (int z = std::max(0, sum - kBlockSide + 1); z <= std::min(sum, kBlockSide - 1); ++z)
      for (int x = 0; x < kBlockSide; x += 4)
        visit(static_cast<std::size_t>(kAlongZ * z + kAlongY * (sum - z) + x), sum - z, z);
}

// What the rows before lead to. Only sums, which no compiler contracts: the bits are the same when
// a block is packed and when it is unpacked.
Float4 expectedAt(const float* node, int y, int z) {
  if (y > 0 && z > 0)
    return load(node - kAlongY) + (load(node - kAlongZ) - load(node - kAlongY - kAlongZ));
  if (y + z == 0) return Float4{};
  const int step = y > 0 ? kAlongY : kAlongZ;
  const Float4 last = load(node - step);
  return y + z > 1 ? last + (last - load(node - 2 * step)) : last;
}

// Floats in their order as integers, so that near ones differ in few low bits; its own inverse.
Word4 ordered(Word4 bits) {
  return bits ^ (-(bits >> 31)) >> 1;
}

// A difference of either sign as a number that is small if it is.
Word4 folded(Word4 difference) {
  return difference << 1 ^ -(difference >> 31);
}

Word4 unfolded(Word4 code) {
  return code >> 1 ^ -(code & 1);
}

// Widths of codes by four bits: 0, 2 .. 28 and 32.
unsigned widthOf(unsigned level) {
  return level == 15 ? 32 : 2 * level;
}

unsigned levelFor(Word4 code) {
  const int width = std::bit_width(code[0] | code[1] | code[2] | code[3]);
  return width > 28 ? 15 : static_cast<unsigned>(width + 1) / 2;
}

unsigned bitsOf(Int4 four) {
  const Int4 bits = four & Int4{1, 2, 4, 8};
  return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

} // namespace

DistanceBlock::DistanceBlock(const DistanceNodes& nodes) {
  const auto outside = std::count(nodes.phi.begin(), nodes.phi.end(), kBeyondBand);
  const auto inside = std::count(nodes.phi.begin(), nodes.phi.end(), -kBeyondBand);
  fill_ = inside > outside ? -kBeyondBand : kBeyondBand;

  DistanceNodes met; // those that are not held as what was expected of them
  std::array<std::uint32_t, 4 * (kFours + 2)> data{};
  std::size_t bit = 0;
  forFours([&](std::size_t first, int y, int z) {
    const Float4 phi = load(&nodes.phi[first]), expected = expectedAt(&met.phi[first], y, z);
    const Int4 is_held = phi != fill_;
    const Float4 next = is_held ? phi : expected;
    store(next, &met.phi[first]);
    const Word4 code = folded(ordered(Word4(next)) - ordered(Word4(expected)));
    const unsigned level = levelFor(code), in_row = first % kBlockSide;
    held_[first / kBlockSide] |= static_cast<std::uint8_t>(bitsOf(is_held) << in_row);
    level_[first / kBlockSide] |= static_cast<std::uint8_t>(level << in_row);
    std::uint32_t* at = &data[bit / 32 * 4];
    const unsigned shift = bit % 32;
    store(load(at) | code << shift, at);
    store(code >> 1 >> (31 - shift), at + 4);
    bit += widthOf(level);
  });
  words_ = static_cast<std::uint32_t>(4 * (bit / 32 + 2)); // two fours are read at once
  data_ = std::make_unique_for_overwrite<std::uint32_t[]>(words_);
  std::copy_n(data.begin(), words_, data_.get());
}

void DistanceBlock::unpack(DistanceNodes& nodes) const {
  std::size_t bit = 0;
  forFours([&](std::size_t first, int y, int z) {
    const std::uint32_t* at = data_.get() + bit / 32 * 4;
    const unsigned shift = bit % 32, width = widthOf(level_[first / kBlockSide] >> first % 8 & 15U);
    const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << width) - 1);
    const Word4 code = (load(at) >> shift | load(at + 4) << 1 << (31 - shift)) & mask;
    bit += width;
    const Word4 expected = Word4(expectedAt(&nodes.phi[first], y, z));
    store(ordered(ordered(expected) + unfolded(code)), &nodes.phi[first]);
  });
  for (std::size_t first = 0; first < kBlockNodes; first += 4) {
    const Int4 held = held_[first / kBlockSide] >> first % kBlockSide & Int4{1, 2, 4, 8};
    const Float4 fill = {fill_, fill_, fill_, fill_};
    store(held != 0 ? load(&nodes.phi[first]) : fill, &nodes.phi[first]);
  }
}

float DistanceBlock::at(std::size_t node) const {
  return (held_[node / kBlockSide] >> node % kBlockSide & 1) != 0 ? phi()[node] : fill_;
}

bool operator==(const DistanceBlock& a, const DistanceBlock& b) {
  return a.held_ == b.held_ && a.level_ == b.level_ && a.fill_ == b.fill_ && a.words_ == b.words_ &&
         std::equal(a.data_.get(), a.data_.get() + a.words_, b.data_.get());
}

} // namespace patina
