// Textured faces as plain data for kernels of any instruction set (TexturePatches).
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/fourier/series_value.h"

namespace patina {

struct HapticTexture;

struct PatchTexture {
  SeriesTable line; // without cells if the texture is more than a line
  const HapticTexture* texture = nullptr;
};

struct TexturePatch {
  double x[4], y[4]; // coefficients of x, y and z of the world, and the constant
  const PatchTexture* texture;
  std::int32_t fade; // index of the fade; -1: none
};

struct PatchTable {
  double middle[4]; // [m, world]; the last is -1, so that p - middle ends in 1 for the constant
  const std::int32_t* patch_of; // per face; -1: none
  const TexturePatch* patches;
  std::size_t faces;
};

} // namespace patina
