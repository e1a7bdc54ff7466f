// Maps each texel to the face that it shows (K16).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/atlas/texture_layout.h"

namespace patina {

// Texel (i, j) has its centre at u = (i + 0.5) / width, v = (j + 0.5) / height; row 0 is at v = 0,
// the bottom of a picture. Each texel has at most one owner and thus shows one point of the
// surface, so that paint never appears twice, even if faces overlap in the image.
struct TexelMap {
  int width = 0, height = 0;
  std::vector<std::int32_t> owner; // owning face, -1 = none; i varies fastest

  std::int32_t ownerAt(int i, int j) const {
    return owner[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(i)];
  }
  Vec2 step() const { return {1.0 / width, 1.0 / height}; } // spacing of texels
  Vec2 centre(int i, int j) const { return {(i + 0.5) / width, (j + 0.5) / height}; }
};

// A face owns the texels whose centres it covers: by the top-left rule exactly one of two faces at
// a common edge, and the lowest face where faces overlap. Texels up to kGutter outside a chart
// belong to its nearest face. A face that covers no centre owns the texel that holds it unless
// another face covers that one. Mirrored faces count like others. Linear in texels and faces;
// parallel; deterministic.
TexelMap texelMap(const CornerUvs& uvs, int width, int height);

// Returns the owner's barycentric coordinates at a texel's centre, clamped to the face for a centre
// outside it (a gutter). Returns one third each for a face without area.
Vec3 texelBarycentric(const std::array<Vec2, 3>& uv, double u, double v);

// Texels [i0, i1) x [j0, j1), clipped to the image, that can show the part of a face within
// `radius` [m] of `centre`: bounds of the sphere's ellipse in texel space, grown by the gutter.
struct TexelBox {
  int i0 = 0, j0 = 0, i1 = 0, j1 = 0;
};
TexelBox texelsNear(const std::array<Vec3, 3>& corners, const std::array<Vec2, 3>& uv,
                    const Vec3& centre, double radius, int width, int height);

} // namespace patina
