// Where a camera sees a point, and along which ray it sees a pixel (A04).
#pragma once

#include "acquisition/camera.h"

namespace patina {

// Pixel of a point of the camera's frame that lies before it.
Vec2 pixelOf(const Camera& camera, const Vec3& in_camera);
// The lens's part of it: from the plane z = 1 to where a pinhole would have to see it.
Vec2 distorted(const Camera& camera, const Vec2& flat);
// Point of the plane z = 1 that the pixel shows; exact to 1e-9 where the lens can be inverted.
Vec2 flatOf(const Camera& camera, const Vec2& pixel);
// Where the pixel would be without the lens, and back.
Vec2 straightened(const Camera& camera, const Vec2& pixel);
Vec2 bentBack(const Camera& camera, const Vec2& straight);

} // namespace patina
