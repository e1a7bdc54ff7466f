// Maps a mesh's surface to the unit square of an image.
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
  bool generated = false; // true: a generated atlas; false: the mesh's own coordinates
  int charts = 0;         // connected pieces in the image
};

// Texels on each side between charts. A bilinear look-up at a chart's edge never reads another
// chart (K16).
inline constexpr int kGutter = 2;

// Returns why the mesh's own coordinates cannot carry paint, or an empty text. They must be finite,
// exist for every face, fill a hundredth of the unit square and nothing outside it; a thousandth of
// the surface may lack area there; no two faces may overlap.
std::string ownLayoutFault(const TriangleMesh& mesh);

// Returns the mesh's own coordinates if ownLayoutFault() finds no fault, otherwise an atlas.
TextureLayout textureLayout(const TriangleMesh& mesh, int image_size);

// Generates charts of connected faces, each projected onto a plane so that no two of its faces
// overlap and no face is stretched by more than 2. All have one scale and are packed with 2 kGutter
// texels between them at image_size. Parts of one chart that come closer than that are close in
// space too. Faces without area get one point. If the image is too small for the number of charts
// (more than one in some 50 texels), the faces of the smallest charts also get one point, of the
// next chart, and show its colour. Duplicate faces share their UVs unless they face opposite ways.
// Deterministic. Throws invalid_argument for a size outside 16 .. 16384.
TextureLayout generateAtlas(const TriangleMesh& mesh, int image_size);

// Returns false if a face's coordinates lie in one line or point.
bool hasArea(const std::array<Vec2, 3>& uv);

} // namespace patina
