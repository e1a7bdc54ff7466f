// Interpolates a cell whose eight nodes are stored, as every sample of a field does. Inline,
// because it takes most of a tick.
#pragma once

#include <cstdint>

#include "field/store/four.h"
#include "field/store/surface_field.h"

namespace patina {

// Returns {phi, gx, gy, gz}.
inline Float4 load(const SampleNode& node) {
  Float4 value;
  __builtin_memcpy(&value, __builtin_assume_aligned(&node, 16), sizeof(value));
  return value;
}

inline constexpr std::size_t kRow = kSampleSide, kLayer = kSampleSide * kSampleSide;

struct BandCell {
  const SampleNode* node; // the lowest of its eight
  float fx, fy, fz;
};

// Returns false unless all eight nodes are stored. last: last node per axis; cells lie in [0,
// last). NaN and infinity fail the comparisons, so that no out-of-range value is converted.
// Unsigned, because signed division costs a tenth of the look-up.
inline bool findCell(const SurfaceField& field, const Vec3& last, const Vec3& q,
                     BandCell& cell) noexcept {
  const double x = q[0], y = q[1], z = q[2];
  if (!(x >= 0 && y >= 0 && z >= 0 && x < last[0] && y < last[1] && z < last[2])) return false;
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const auto part = [](int a) { return static_cast<unsigned>(a) / kBlockSide; };
  const auto within = [](int a) { return static_cast<unsigned>(a) % kBlockSide; };
  const std::int32_t slot =
      field.slotOf(static_cast<int>(part(i)), static_cast<int>(part(j)), static_cast<int>(part(k)));
  if (slot < 0) return false;
  const SampleBlock& block = *field.sample[static_cast<std::size_t>(slot)];
  const unsigned bi = within(i), bj = within(j), bk = within(k);
  if (!block.cellComplete(static_cast<int>(bi), static_cast<int>(bj), static_cast<int>(bk)))
    return false;
  cell.node = &block.node[(bk * kSampleSide + bj) * kSampleSide + bi];
  cell.fx = static_cast<float>(x - i);
  cell.fy = static_cast<float>(y - j);
  cell.fz = static_cast<float>(z - k);
  return true;
}

struct Blend {
  Float4 sum;        // trilinear phi and gradient
  float taylor_half; // 1/2 sum w_i g_i . (x - x_i), F15; zero if not requested
};

template <bool kHigh> inline Blend blend(const BandCell& cell) noexcept {
  const SampleNode* node = cell.node;
  const float fx = cell.fx, fy = cell.fy, fz = cell.fz;
  const float ex = 1 - fx, ey = 1 - fy, ez = 1 - fz;
  const float a = ex * ey, b = fx * ey, c = ex * fy, d = fx * fy;
  const Float4 t0 = load(node[0]) * (a * ez), t1 = load(node[1]) * (b * ez);
  const Float4 t2 = load(node[kRow]) * (c * ez), t3 = load(node[kRow + 1]) * (d * ez);
  const SampleNode* up = node + kLayer;
  const Float4 t4 = load(up[0]) * (a * fz), t5 = load(up[1]) * (b * fz);
  const Float4 t6 = load(up[kRow]) * (c * fz), t7 = load(up[kRow + 1]) * (d * fz);
  const Float4 odd = (t1 + t3) + (t5 + t7), s23 = t2 + t3, s67 = t6 + t7, upper = (t4 + t5) + s67;
  const Float4 sum = ((t0 + t1) + s23) + upper;
  if constexpr (!kHigh) return {sum, 0};
  // sum w_i g_i . (f - c_i): corners c_i with a coordinate of 1 are the upper half along it.
  const Float4 y_upper = s23 + s67;
  const float moment =
      (fx * sum[1] - odd[1]) + (fy * sum[2] - y_upper[2]) + (fz * sum[3] - upper[3]);
  return {sum, 0.5F * moment};
}

} // namespace patina
