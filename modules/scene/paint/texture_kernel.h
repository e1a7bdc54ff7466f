// Kernel that finds and evaluates the texture under a point, compiled once per instruction set: a
// source defines PATINA_KERNEL (a unique name) and includes this. It must use only always inlined
// functions of other headers, or the linker might keep the wrong copy for the whole program.
#pragma once

#include "scene/fourier/series_polynomial.h"
#include "scene/paint/texture_hit.h"

namespace patina::PATINA_KERNEL {

[[gnu::always_inline]] inline float lesser(float a, float b) noexcept {
  return a < b ? a : b;
}

[[gnu::always_inline]] inline SeriesValue valueAt(const SeriesTable& line, double x) noexcept {
  const CellPosition place = line.ring.at(x);
  const double* cell = line.cells + 4 * line.rows * place.step;
  const double t = 2 * place.fraction - 1;
  switch (line.rows) {
  case 1:
    return polynomial<1>(cell, t);
  case 2:
    return polynomial<2>(cell, t);
  case 3:
    return polynomial<3>(cell, t);
  default:
    return polynomial<4>(cell, t);
  }
}

void findTextureHit(const FaceTable& faces, const PatchTable& patches, double x, double y, double z,
                    std::int32_t near_face, TextureHit& foot, double* result) noexcept {
  foot.face = -1;
  foot.patch = nullptr;
  constexpr Int4 kThree = {-1, -1, -1, 0};
  const Double4 at = {x, y, z, 0};
  const Double4 on_mesh = at - *reinterpret_cast<const Double4At*>(faces.middle);
  for (int crossed = 0;; ++crossed) {
    const FaceFrame& frame = faces.frames[near_face];
    Float4 corner;
    __builtin_memcpy(&corner, frame.corner, sizeof corner);
    const Float4 p =
        __builtin_convertvector(on_mesh - __builtin_convertvector(corner, Double4), Float4);
    const Float4 over = p[0] * (Float4)(frame.lanes[0] & kThree) +
                        p[1] * (Float4)(frame.lanes[1] & kThree) +
                        p[2] * (Float4)(frame.lanes[2] & kThree);
    const float w1 = over[0], w2 = over[1], rest = 1 - (w1 + w2), two = lesser(w1, w2),
                least = lesser(two, rest);
    if (least > kInteriorMargin) [[likely]] {
      foot.above = over[2];
      break;
    }
    if (crossed == kMaxCrossed || least > 0) return; // on an edge
    // Corner k lies opposite the edge from k + 1 to k + 2.
    near_face = frame.lanes[rest <= two ? 1 : w1 <= w2 ? 2 : 0][3];
    if (near_face < 0) return;
  }
  foot.face = near_face;
  const std::int32_t index = patches.patch_of[near_face];
  if (index < 0) return;
  const TexturePatch& patch = patches.patches[index];
  foot.patch = &patch;
  const SeriesTable& line = patch.texture->line;
  if (!line.cells) return;
  const Double4 by = *reinterpret_cast<const Double4At*>(patch.x),
                parts = (at - *reinterpret_cast<const Double4At*>(patches.middle)) * by;
  const SeriesValue value = valueAt(line, (parts[0] + parts[1]) + (parts[2] + parts[3]));
  result[0] = value.value;
  result[1] = line.slope_scale * value.slope;
}

} // namespace patina::PATINA_KERNEL
