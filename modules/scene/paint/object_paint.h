// What a person painted or laid onto one object. Every part is absent until it first is.
#pragma once

#include <memory>

#include "geometry/atlas/texture_layout.h"
#include "scene/fourier/laid_textures.h"
#include "scene/paint/material_map.h"
#include "scene/paint/tiled_image.h"

namespace patina {

struct ObjectPaint {
  TextureLayout layout; // with the first image
  // Premultiplied sRGB and coverage, 4 channels: what is seen is rgb + (1 - a) * the object's own
  // colour. Blended as sRGB values, as the paper does (K18).
  std::shared_ptr<const TiledImage> color;
  // One channel g, any sign: the height is relief.height * g [m] outward (K21).
  std::shared_ptr<const TiledImage> relief;
  std::shared_ptr<const MaterialMap> material;
  std::shared_ptr<const LaidTextures> textures{}; // scanned ones, along paths over its faces
};

inline constexpr int kColorChannels = 4;

// Of what was painted; not the layout.
std::size_t bytes(const ObjectPaint& paint);
bool same(const ObjectPaint& a, const ObjectPaint& b); // bitwise, layouts too

} // namespace patina
