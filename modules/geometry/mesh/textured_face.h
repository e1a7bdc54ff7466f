// Haptic texture coordinates on a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

// Texture of one face, so that seams are possible (A15). Lists are sorted by face without
// duplicates; faces not in it have no texture.
struct TexturedFace {
  std::int32_t face = 0;
  std::int32_t texture = 0;       // identifier in a table of textures, not an index; >= 0
  std::array<Vec2, 3> coords{{}}; // x along the scan's path and y to its left, at each corner [m]
  bool operator==(const TexturedFace&) const = default;
};

} // namespace patina
