// Colours of a mesh file's faces.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/types.h"

namespace patina {

// Red, green and blue as sRGB in [0, 1], then 1; four zeros mean no colour.
using Rgba = std::array<float, 4>;

struct MeshPicture {
  std::filesystem::path file;
  // Texture point t shows scale * t + offset of the picture.
  Vec2 scale{1, 1}, offset{0, 0};
  bool repeats = true; // tiles outside the unit square; false: the picture's edge is extended
};

// Colours in order of precedence: a face shows its picture if it can be read, else the colours of
// its vertices, else its own.
struct MeshColors {
  std::vector<Rgba> vertices; // one a vertex, or empty
  std::vector<Rgba> faces;    // one a triangle, or empty
  std::vector<MeshPicture> pictures;
  std::vector<std::int32_t> picture_of; // one a triangle: index in `pictures` or -1; or empty

  bool empty() const { return vertices.empty() && faces.empty() && picture_of.empty(); }
};

// Divides by `white`, the value of a full colour. White 0 means 1, or 255 if some value is 2 or
// more. A colour that is not finite is removed; the others are clamped to [0, 1].
void scaleColors(std::vector<Rgba>& colors, double white);

} // namespace patina
