#include "field/store/packed_distance.h"

#include <algorithm>
#include <bit>

#include "field/sampling/four.h"

namespace patina {
namespace {

constexpr std::size_t kSide = kBlockSide, kAlongY = kSide, kAlongZ = kSide * kSide;
constexpr std::size_t kNodes = kBlockNodes;

// visit(index of the first, what the rows before lead to) for all fours of nodes along x; it stores
// what they are. Each comes after those that it is expected from but away from them, so that none
// need wait for the last. Only sums, which no compiler contracts: the bits are the same when a
// block is packed and when it is unpacked.
template <class Visit> void foresee(const float* phi, const Visit& visit) {
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
    more_inside += (phi == kBeyondBand) - (phi == -kBeyondBand);
  }
  const int more = more_inside[0] + more_inside[1] + more_inside[2] + more_inside[3];
  return more > 0 ? -kBeyondBand : kBeyondBand;
}

} // namespace

DistanceBlock::DistanceBlock(const DistanceNodes& nodes) : fill_(commonerEnd(nodes)) {
  DistanceNodes met; // those that are not held as what was expected of them
  std::array<std::uint32_t, kNodes> code;
  foresee(met.phi.data(), [&](std::size_t n, Float4 expected) {
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
  Word4 begun{}; // the words that are not full
  for (std::size_t n = 0; n < kNodes; n += 4) {
    const Word4 next = load(&code[n]);
    const std::size_t level = levelFor(next);
    const unsigned shift = bit % 32;
    level_[n / kSide] |= static_cast<std::uint8_t>(level << n % kSide);
    begun |= next << shift;
    store(begun, &data[bit / 32 * 4]);
    bit += kWidth[level];
    const std::uint32_t full = 0U - (shift + kWidth[level]) / 32; // a mask: a jump is not foreseen
    begun = (begun & ~full) | (next >> 1 >> (31 - shift) & full);
  }
  store(begun, &data[bit / 32 * 4]);
  words_ = static_cast<std::uint32_t>(4 * (bit / 32 + 2)); // two fours are read at once
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
  foresee(phi, [&](std::size_t n, Float4 expected) {
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

} // namespace patina
