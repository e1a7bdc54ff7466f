// A picture laid onto an object: as its texture coordinates say, or projected.
#pragma once

#include <memory>

#include "authoring/brush/paint_surface.h"
#include "pictures/picture.h"

namespace patina {

// mapped: through the mesh's own texture coordinates, repeated outside the unit square. Along an
// axis: spread over the object's box in its frame, onto faces that look either way; upright and not
// mirrored as seen from +x, -y (up is z) and +z (up is y).
enum class Projection { mapped, x, y, z };
enum class PictureTarget { color, relief };

// The object's paint with the picture in place of what its coverage (alpha) hides. Relief takes the
// grey value as g. Throws Error if `mapped` and the mesh has no coordinates.
std::shared_ptr<const ObjectPaint> laid(const PaintSurface& surface, const Scene& scene,
                                        std::size_t object, const Picture& picture,
                                        Projection projection, PictureTarget target);

} // namespace patina
