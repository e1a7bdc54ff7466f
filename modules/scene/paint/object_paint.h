// Paint, images and textures of one object. Absent parts are null.
#pragma once

#include <memory>

#include "geometry/atlas/texture_layout.h"
#include "scene/fourier/texture_mappings.h"
#include "scene/paint/material_map.h"
#include "scene/paint/tiled_image.h"

namespace patina {

struct ObjectPaint {
  TextureLayout layout; // set with the first image
  // Premultiplied sRGB and coverage, 4 channels: the visible colour is rgb + (1 - a) * the object's
  // own colour. Blended as sRGB values, as in the paper (K18).
  std::shared_ptr<const TiledImage> color;
  // One channel, any sign: the height is relief.height * value [m] outward (K21).
  std::shared_ptr<const TiledImage> relief;
  std::shared_ptr<const MaterialMap> material;
  std::shared_ptr<const TextureMappings> textures{}; // scanned, along paths on its faces
};

inline constexpr int kColorChannels = 4;

// Counts the paint without the layout.
std::size_t bytes(const ObjectPaint& paint);
bool same(const ObjectPaint& a, const ObjectPaint& b); // bitwise, with layouts

} // namespace patina
