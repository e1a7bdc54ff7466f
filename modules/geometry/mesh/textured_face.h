// Where on a mesh which haptic texture lies.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

// Kept a face, so that seams are allowed (A15). In a list faces ascend and none is there twice;
// faces that are not in it have no texture.
struct TexturedFace {
  std::int32_t face = 0;
  std::int32_t texture = 0;   // 0 or more: a number in a table of textures, not a place in it
  std::array<Vec2, 3> at{{}}; // x along the scan's path and y to its left, at each corner [m]
  bool operator==(const TexturedFace&) const = default;
};

} // namespace patina
