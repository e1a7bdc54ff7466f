// Which piece of the surface a texel shows (K16).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/atlas/texture_layout.h"

namespace patina {

// Texel (i, j) has its centre at u = (i + 0.5) / width, v = (j + 0.5) / height; row 0 is at v = 0,
// the bottom of a picture. Every texel has one owner at most and with it one point of the surface,
// so that a place is painted once, whatever overlaps in the image.
struct TexelMap {
  int width = 0, height = 0;
  std::vector<std::int32_t> owner; // face, -1 = shows nothing; i fastest

  std::int32_t ownerAt(int i, int j) const {
    return owner[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(i)];
  }
  Vec2 step() const { return {1.0 / width, 1.0 / height}; } // from texel to texel
  Vec2 centre(int i, int j) const { return {(i + 0.5) / width, (j + 0.5) / height}; }
};

// A texel whose centre a face covers is owned by it: by the top-left rule exactly one of two that
// share an edge, the lowest face where they overlap. Texels round a chart, up to kGutter away,
// belong to the nearest face of it; so does the texel that holds a face which covers no centre,
// unless another covers it. Flipped faces (mirrored coordinates) count like others. Linear in
// texels and faces; parallel; deterministic.
TexelMap texelMap(const CornerUvs& uvs, int width, int height);

// The barycentric coordinates that the owner has at a texel's centre, moved to the nearest point of
// the face where the centre lies outside it (a gutter). One third each for a face without area.
Vec3 texelBarycentric(const std::array<Vec2, 3>& uv, double u, double v);

// Texels [i0, i1) x [j0, j1), clipped to the image, that can show the part of a face within
// `radius` [m] of `centre`: a bound by the ellipse of the sphere in texel space, grown by the
// gutter.
struct TexelBox {
  int i0 = 0, j0 = 0, i1 = 0, j1 = 0;
};
TexelBox texelsNear(const std::array<Vec3, 3>& corners, const std::array<Vec2, 3>& uv,
                    const Vec3& centre, double radius, int width, int height);

} // namespace patina
