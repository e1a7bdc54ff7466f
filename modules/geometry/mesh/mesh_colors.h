// The colours that a mesh file gives to its faces.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/types.h"

namespace patina {

// Red, green and blue as sRGB in [0, 1], then 1; four zeros where there is no colour.
using Rgba = std::array<float, 4>;

struct MeshPicture {
  std::filesystem::path file;
  // A texture point t shows the place scale * t + offset of the picture.
  Vec2 scale{1, 1}, offset{0, 0};
  bool repeats = true; // outside the unit square; false: the picture's edge goes on
};

// A face shows its picture. Where it has none, or that cannot be read, it shows the colours of its
// vertices, and where those have none, its own.
struct MeshColors {
  std::vector<Rgba> vertices; // one a vertex, or empty
  std::vector<Rgba> faces;    // one a triangle, or empty
  std::vector<MeshPicture> pictures;
  std::vector<std::int32_t> picture_of; // one a triangle: in `pictures`, -1 = none; or empty

  bool empty() const { return vertices.empty() && faces.empty() && picture_of.empty(); }
};

// Divides by `white`, the value of a full colour. 0 stands for 1, or for 255 where some value is 2 or
// more. A colour that is not finite becomes none; the others are clamped to [0, 1].
void scaleColors(std::vector<Rgba>& colors, double white);

} // namespace patina
