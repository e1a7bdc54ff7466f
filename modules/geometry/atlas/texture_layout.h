// Where a mesh's surface lies in the unit square of an image.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

using CornerUvs = std::vector<std::array<Vec2, 3>>; // one entry a triangle, in [0, 1]^2

struct TextureLayout {
  std::shared_ptr<const CornerUvs> uvs;
  bool made = false; // an atlas of ours; false = the mesh's own coordinates
  int charts = 0;    // connected pieces in the image
};

// Texels between charts: half of them belong to either, so that a bilinear look-up at a chart's
// edge never reads another chart (K16).
inline constexpr int kGutter = 2;

// Says why paint cannot lie by a mesh's own coordinates; empty if it can: every face has some, they
// are finite, lie in the unit square and fill a hundredth of it, all but a thousandth of the surface
// has area there, and no two faces overlap.
std::string ownLayoutFault(const TriangleMesh& mesh);

// Returns the mesh's own coordinates where nothing is wrong with them, otherwise an atlas.
TextureLayout textureLayout(const TriangleMesh& mesh, int image_size);

// Charts of connected faces, each projected onto a plane so that no two faces of it overlap and no
// face is stretched by more than 2, scaled alike and packed with 2 kGutter texels between them at
// image_size. Parts of one chart that come nearer than that are near in space too. Faces without
// area get a point. So do, where the image is too small for a mesh in very many pieces (more than
// one in some 50 texels), the faces of the smallest: one of the next chart's, to show its colour.
// Faces that the mesh holds twice have one place, unless they face opposite ways. Deterministic.
// Throws invalid_argument for a size that is not in 16 .. 16384.
TextureLayout madeAtlas(const TriangleMesh& mesh, int image_size);

// False where a face's coordinates lie in one line or point: it has no inside in the image.
bool hasArea(const std::array<Vec2, 3>& uv);

} // namespace patina
