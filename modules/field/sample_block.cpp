#include "field/sample_block.h"

#include <cmath>
#include <cstring>

namespace patina {
namespace {

// phi of a block's nodes and of the layers around them that gradients read.
constexpr int kPadded = kBlockSide + 3; // nodes -1 .. 9: the 9^3 samples and both their neighbours
using PaddedPhi = std::array<float, kPadded * kPadded * kPadded>;

constexpr std::size_t paddedIndex(int x, int y, int z) {
  return static_cast<std::size_t>(((z + 1) * kPadded + (y + 1)) * kPadded + (x + 1));
}

// Of padded coordinate -1 .. 9: which of the three blocks along an axis, and where in it.
constexpr int neighbourOf(int c) {
  return c < 0 ? 0 : c < kBlockSide ? 1 : 2;
}
constexpr int indexIn(int c) {
  return c & (kBlockSide - 1);
}

// The 27 blocks about one, [z][y][x]; those that are not stored read as constant rows.
struct Neighbours {
  std::array<const float*, 27> phi{};
  std::array<float, 27> fill{};
};

Neighbours neighboursOf(const SurfaceField& field, const std::array<int, 3>& at) {
  Neighbours result;
  std::size_t n = 0;
  for (int bz = at[2] - 1; bz <= at[2] + 1; ++bz)
    for (int by = at[1] - 1; by <= at[1] + 1; ++by)
      for (int bx = at[0] - 1; bx <= at[0] + 1; ++bx, ++n) {
        const bool in_grid = bx >= 0 && by >= 0 && bz >= 0 && bx < field.blocks[0] &&
                             by < field.blocks[1] && bz < field.blocks[2];
        const std::int32_t slot = in_grid ? field.slotOf(bx, by, bz) : SurfaceField::kOutside;
        result.fill[n] = slot == SurfaceField::kInside ? -kBeyondBand : kBeyondBand;
        if (slot >= 0) result.phi[n] = field.distance[static_cast<std::size_t>(slot)]->phi.data();
      }
  return result;
}

void gather(const Neighbours& about, PaddedPhi& padded) {
  float* out = padded.data();
  for (int z = -1; z < kPadded - 1; ++z)
    for (int y = -1; y < kPadded - 1; ++y, out += kPadded) {
      const auto first = static_cast<std::size_t>(9 * neighbourOf(z) + 3 * neighbourOf(y));
      const int row = (indexIn(z) * kBlockSide + indexIn(y)) * kBlockSide;
      const float* low = about.phi[first];
      const float* own = about.phi[first + 1];
      const float* high = about.phi[first + 2];
      out[0] = low ? low[row + kBlockSide - 1] : about.fill[first];
      if (own)
        std::memcpy(out + 1, own + row, kBlockSide * sizeof(float));
      else
        for (int x = 1; x <= kBlockSide; ++x) out[x] = about.fill[first + 1];
      out[kBlockSide + 1] = high ? high[row] : about.fill[first + 2];
      out[kBlockSide + 2] = high ? high[row + 1] : about.fill[first + 2];
    }
}

// Four nodes along x at once: the compiler's portable vectors, SSE or NEON alike.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

Float4 load(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

Int4 isStored(Float4 phi) {
  return (phi < kBeyondBand) & (phi > -kBeyondBand);
}

// K04: central where both neighbours are stored, one-sided where one is, zero where none is.
struct Differences {
  Float4 central, before, after;
};
Differences differences(const float* node, int step, Float4 here) {
  const Float4 before = load(node - step), after = load(node + step);
  const Int4 has_before = isStored(before), has_after = isStored(after);
  const Float4 low = has_before ? before : here, high = has_after ? after : here;
  const Float4 half = {0.5F, 0.5F, 0.5F, 0.5F}, one = {1, 1, 1, 1};
  Differences d;
  d.central = (high - low) * (has_before & has_after ? half : one);
  d.before = has_before ? here - low : d.central;
  d.after = has_after ? high - here : d.central;
  return d;
}

// Beside a crease a central difference is the slope of neither side. Of the eight ways to take one
// difference an axis those count that have a distance's slope, 1: they lie on the node's own side.
// Where the surface is smooth all do, and their mean is the central difference.
void takeOwnSide(Differences& x, Differences& y, Differences& z) {
  const Float4 one = {1, 1, 1, 1}, none = {};
  const Float4 off = x.central * x.central + y.central * y.central + z.central * z.central - one;
  const Float4 noticed = {0.002F, 0.002F, 0.002F, 0.002F};
  const Int4 beside = (off > noticed) | (off < -noticed);
  if (!(beside[0] | beside[1] | beside[2] | beside[3])) return;
  const Float4 least = {1e-5F, 1e-5F, 1e-5F, 1e-5F};
  Float4 gx = none, gy = none, gz = none, sum = none;
  for (int choice = 0; choice < 8; ++choice) {
    const Float4 cx = choice & 1 ? x.after : x.before, cy = choice & 2 ? y.after : y.before,
                 cz = choice & 4 ? z.after : z.before;
    const Float4 error = cx * cx + cy * cy + cz * cz - one;
    const Float4 weight = one / (error * error + least);
    gx += weight * cx;
    gy += weight * cy;
    gz += weight * cz;
    sum += weight;
  }
  x.central = beside ? gx / sum : x.central;
  y.central = beside ? gy / sum : y.central;
  z.central = beside ? gz / sum : z.central;
}

void fillFour(const float* node, SampleNode* out) {
  const Float4 phi = load(node), none = {};
  const Int4 stored = isStored(phi);
  Differences x = differences(node, 1, phi), y = differences(node, kPadded, phi),
              z = differences(node, kPadded * kPadded, phi);
  takeOwnSide(x, y, z);
  const Float4 gx = stored ? x.central : none;
  const Float4 gy = stored ? y.central : none;
  const Float4 gz = stored ? z.central : none;
  const Float4 a = __builtin_shufflevector(phi, gx, 0, 4, 1, 5);
  const Float4 b = __builtin_shufflevector(gy, gz, 0, 4, 1, 5);
  const Float4 c = __builtin_shufflevector(phi, gx, 2, 6, 3, 7);
  const Float4 d = __builtin_shufflevector(gy, gz, 2, 6, 3, 7);
  const Float4 four[] = {
      __builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
      __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
  std::memcpy(static_cast<void*>(out), four, sizeof(four));
}

// The ninth node of a row comes with the three before it once more.
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

} // namespace

std::shared_ptr<const SampleBlock> sampleBlock(const SurfaceField& field, std::size_t slot) {
  PaddedPhi padded;
  gather(neighboursOf(field, field.block_at[slot]), padded);
  auto block = std::make_shared_for_overwrite<SampleBlock>();
  fillNodes(padded, *block);
  fillComplete(padded, *block);
  return block;
}

} // namespace patina
