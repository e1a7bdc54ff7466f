// Textured faces, plain enough for a kernel of any instruction set (TexturePatches).
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/fourier/series_value.h"

namespace patina {

struct FeltTexture;

struct PatchTexture {
  SeriesTable line; // without cells where the texture is more than a line
  const FeltTexture* of = nullptr;
};

struct TexturePatch {
  double x[4], y[4]; // texture coordinates: by each axis of the world, and at the middle
  const PatchTexture* texture;
  std::int32_t fade; // its place among the fades; -1: none
};

struct PatchTable {
  double middle[4]; // [m, world]; the last is -1: a place less it ends in 1, as x and y do
  const std::int32_t* patch_of; // by face; -1: none
  const TexturePatch* patches;
  std::size_t faces;
};

} // namespace patina
