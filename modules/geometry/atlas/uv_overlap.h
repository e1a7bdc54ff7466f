// Finds faces that lie on one another in an image. Internal to the atlas.
#pragma once

#include <optional>

#include "geometry/atlas/texture_layout.h"

namespace patina {

// Texture coordinates this close are one place: a quarter of a texel of the largest image, and what
// files that are written with five decimals or in single precision round by.
inline constexpr double kUvResolution = 1.0 / 65536;

struct UvOverlap {
  std::int32_t a = kNone, b = kNone; // two faces, a < b
};

// Returns two faces that no shift by kUvResolution would part, or nothing if there are none. Faces
// at a common edge or corner do not overlap, nor do the folds that rounding makes of narrow faces;
// faces narrower than kUvResolution are passed over. No sampling: the separating axis theorem on
// pairs from a quadtree. Some n log n for n faces; parallel; deterministic.
std::optional<UvOverlap> findUvOverlap(const CornerUvs& uvs);

} // namespace patina
