#include "field/store/sample_block.h"

#include <cmath>
#include <cstring>

#include "field/store/four.h"

namespace patina {
namespace {

// phi of a block's nodes and of the surrounding layers that gradients need.
constexpr int kPadded = kBlockSide + 5; // nodes -2 .. 10: the 9^3 samples and two on either side
using PaddedPhi = std::array<float, kPadded * kPadded * kPadded>;

constexpr std::size_t paddedIndex(int x, int y, int z) {
  return static_cast<std::size_t>(((z + 2) * kPadded + (y + 2)) * kPadded + (x + 2));
}

// Returns the block along an axis of a padded coordinate -2 .. 10: 0, 1 or 2.
constexpr int neighbourOf(int c) {
  return c < 0 ? 0 : c < kBlockSide ? 1 : 2;
}
constexpr int indexIn(int c) {
  return c & (kBlockSide - 1);
}

// The 27 blocks about one, [z][y][x]; unstored ones read as constant rows.
struct Neighbours {
  std::array<const float*, 27> phi{};
  std::array<float, 27> fill{};
};

Neighbours neighboursOf(const NodeReader& nodes, std::size_t middle) {
  const SurfaceField& field = nodes.field();
  const std::array<int, 3>& at = field.block_at[middle];
  Neighbours result;
  std::size_t n = 0;
  for (int bz = at[2] - 1; bz <= at[2] + 1; ++bz)
    for (int by = at[1] - 1; by <= at[1] + 1; ++by)
      for (int bx = at[0] - 1; bx <= at[0] + 1; ++bx, ++n) {
        const bool in_grid = bx >= 0 && by >= 0 && bz >= 0 && bx < field.blocks[0] &&
                             by < field.blocks[1] && bz < field.blocks[2];
        const std::int32_t slot = in_grid ? field.slotOf(bx, by, bz) : SurfaceField::kOutside;
        result.fill[n] = backgroundOf(slot);
        if (slot >= 0) result.phi[n] = nodes.block(static_cast<std::size_t>(slot)).phi.data();
      }
  return result;
}

void gather(const Neighbours& about, PaddedPhi& padded) {
  float* out = padded.data();
  for (int z = -2; z < kPadded - 2; ++z)
    for (int y = -2; y < kPadded - 2; ++y, out += kPadded) {
      const auto first = static_cast<std::size_t>(9 * neighbourOf(z) + 3 * neighbourOf(y));
      const int row = (indexIn(z) * kBlockSide + indexIn(y)) * kBlockSide;
      const float* low = about.phi[first];
      const float* own = about.phi[first + 1];
      const float* high = about.phi[first + 2];
      for (int x = 0; x < 2; ++x) out[x] = low ? low[row + kBlockSide - 2 + x] : about.fill[first];
      if (own)
        std::memcpy(out + 2, own + row, kBlockSide * sizeof(float));
      else
        for (int x = 0; x < kBlockSide; ++x) out[2 + x] = about.fill[first + 1];
      for (int x = 0; x < 3; ++x)
        out[kBlockSide + 2 + x] = high ? high[row + x] : about.fill[first + 2];
    }
}

Int4 isStored(Float4 phi) {
  return (phi < kBackground) & (phi > -kBackground);
}

Float4 magnitude(Float4 value) {
  const Float4 none = {};
  return value < none ? -value : value;
}

// K04: central if both neighbours are stored, one-sided if one is, zero if none is. A central
// difference across a crease is the slope of neither side, so there the one-sided and the central
// differences of second order are weighted by their smoothness (weighted essentially
// non-oscillatory differences: Liu, Osher & Chan 1994, after Harten, Engquist, Osher & Chakravarthy
// 1987). On a smooth surface and its facets the slope changes equally on both sides and stays
// central.
Float4 difference(const float* node, int step, Float4 here) {
  const Float4 before = load(node - step), after = load(node + step);
  const Int4 has_before = isStored(before), has_after = isStored(after);
  const Float4 low = has_before ? before : here, high = has_after ? after : here;
  const Float4 half = {0.5F, 0.5F, 0.5F, 0.5F}, one = {1, 1, 1, 1};
  const Float4 central = (high - low) * (has_before & has_after ? half : one);

  const Float4 before2 = load(node - 2 * step), after2 = load(node + 2 * step);
  const Float4 bend = after - here - (here - before);
  const Float4 bend_low = here - before - (before - before2),
               bend_high = after2 - after - (after - here);
  const Float4 crease = {0.02F, 0.02F, 0.02F, 0.02F};
  const Int4 creased =
      has_before & has_after & isStored(before2) & isStored(after2) &
      ((magnitude(bend - bend_low) > crease) | (magnitude(bend - bend_high) > crease));
  if (!(creased[0] | creased[1] | creased[2] | creased[3])) return central;
  const Float4 from_low = here - before + half * bend_low,
               from_high = after - here - half * bend_high;
  const Float4 least = {1e-5F, 1e-5F, 1e-5F, 1e-5F};
  const Float4 trust_low = one / (bend_low * bend_low + least),
               trust_high = one / (bend_high * bend_high + least),
               trust = one / (bend * bend + least);
  return creased ? (trust_low * from_low + trust * central + trust_high * from_high) /
                       (trust_low + trust + trust_high)
                 : central;
}

// Smooths a slope over nine differences with spline weights, which reduces the effect of the mesh's
// facets. Keeps the node's own slope if one of them differs, as near a crease or fine relief.
Float4 across(const Float4* about, int step, int u, int v, Float4 own, Int4 stored) {
  constexpr float kOther = 0.03F;
  const Float4 half = {0.5F, 0.5F, 0.5F, 0.5F}, other = {kOther, kOther, kOther, kOther};
  Float4 sum = {};
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const Float4* at = about + i * u + j * v;
      const Float4 slope = half * (at[step] - at[-step]);
      stored &= magnitude(slope - own) < other;
      sum += slope * ((i == 0 ? 2.F / 3 : 1.F / 6) * (j == 0 ? 2.F / 3 : 1.F / 6));
    }
  return stored ? sum : own;
}

void fillFour(const float* node, SampleNode* out) {
  std::array<Float4, 27> about;
  Int4 all = {-1, -1, -1, -1};
  for (int z = -1, n = 0; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x, ++n) {
        about[static_cast<std::size_t>(n)] = load(node + (z * kPadded + y) * kPadded + x);
        all &= isStored(about[static_cast<std::size_t>(n)]);
      }
  const Float4 *middle = &about[13], phi = *middle, none = {};
  const Int4 stored = isStored(phi);
  const auto slope = [&](int step, int in_about, int u, int v) {
    const Float4 own = difference(node, step, phi);
    return stored ? across(middle, in_about, u, v, own, all) : none;
  };
  const Float4 gx = slope(1, 1, 3, 9), gy = slope(kPadded, 3, 1, 9),
               gz = slope(kPadded * kPadded, 9, 1, 3);
  const Float4 a = __builtin_shufflevector(phi, gx, 0, 4, 1, 5);
  const Float4 b = __builtin_shufflevector(gy, gz, 0, 4, 1, 5);
  const Float4 c = __builtin_shufflevector(phi, gx, 2, 6, 3, 7);
  const Float4 d = __builtin_shufflevector(gy, gz, 2, 6, 3, 7);
  const Float4 four[] = {
      __builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
      __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
  std::memcpy(static_cast<void*>(out), four, sizeof(four));
}

// The ninth node of a row is loaded together with the three before it.
void fillNodes(const PaddedPhi& padded, SampleBlock& block) {
  constexpr int kLast = kSampleSide - 4;
  SampleNode* out = block.node.data();
  for (int z = 0; z < kSampleSide; ++z)
    for (int y = 0; y < kSampleSide; ++y, out += kSampleSide) {
      const float* row = &padded[paddedIndex(0, y, z)];
      fillFour(row, out);
      fillFour(row + 4, out + 4);
      fillFour(row + kLast, out + kLast);
    }
}

// Combines cell flags by AND of node flags along x, then y, then z.
void fillComplete(const PaddedPhi& padded, SampleBlock& block) {
  std::array<std::uint64_t, kSampleSide> layer{};
  for (int z = 0; z < kSampleSide; ++z) {
    unsigned previous = 0;
    std::uint64_t cells = 0;
    for (int y = 0; y < kSampleSide; ++y) {
      const float* row = &padded[paddedIndex(0, y, z)];
      unsigned stored = 0;
      for (int x = 0; x < kSampleSide; ++x)
        stored |= static_cast<unsigned>(std::abs(row[x]) < kBackground) << x;
      const unsigned edges = stored & stored >> 1 & 0xFFU;
      if (y > 0) cells |= static_cast<std::uint64_t>(edges & previous) << (kBlockSide * (y - 1));
      previous = edges;
    }
    layer[static_cast<std::size_t>(z)] = cells;
  }
  for (std::size_t z = 0; z < kBlockSide; ++z) block.complete[z] = layer[z] & layer[z + 1];
}

} // namespace

std::shared_ptr<const SampleBlock> sampleBlock(const NodeReader& nodes, std::size_t slot) {
  PaddedPhi padded;
  gather(neighboursOf(nodes, slot), padded);
  auto block = std::make_shared_for_overwrite<SampleBlock>();
  fillNodes(padded, *block);
  fillComplete(padded, *block);
  return block;
}

} // namespace patina
