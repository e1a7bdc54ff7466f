// Applies a picture to an object by its texture coordinates or by projection.
#pragma once

#include <memory>

#include "authoring/brush/paint_surface.h"
#include "pictures/picture.h"

namespace patina {

// mapped: by the mesh's own texture coordinates, repeated outside the unit square. x, y, z:
// projected along that axis over the object's box in its frame, onto faces on both sides; upright
// and not mirrored as seen from +x, -y (up is z) and +z (up is y).
enum class Projection { mapped, x, y, z };
enum class PictureTarget { color, relief };

// Returns the object's paint with the picture composited over it by its alpha. Relief uses the grey
// value. Throws Error if `mapped` and the mesh has no coordinates.
std::shared_ptr<const ObjectPaint> laid(const PaintSurface& surface, const Scene& scene,
                                        std::size_t object, const Picture& picture,
                                        Projection projection, PictureTarget target);

} // namespace patina
