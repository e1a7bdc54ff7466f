// Where a camera sees a point, and along which ray it sees a pixel (A04), for every lens model.
#pragma once

#include <optional>

#include "acquisition/camera.h"

namespace patina {

// Pixel of a point of the camera's frame that lies before it.
Vec2 pixelOf(const Camera& camera, const Vec3& in_camera);

// The lens's part of it: from the plane z = 1 to where a pinhole would have to see it.
Vec2 distorted(const Camera& camera, const Vec2& flat);
// The same with its derivative by `flat`.
struct DistortedPoint {
  Vec2 place;
  Eigen::Matrix2d jacobian;
};
DistortedPoint distortedWithJacobian(const Camera& camera, const Vec2& flat);

// Point of the plane z = 1 that the pixel shows, by Newton's method from `start` (else from where a
// pinhole sees it) to 1e-10; nullopt where there is none: beyond 89 degrees from the axis, and
// where the lens folds.
std::optional<Vec2> flatOf(const Camera& camera, const Vec2& pixel, const Vec2* start = nullptr);

// Where the pixel would be without the lens, and back.
std::optional<Vec2> straightened(const Camera& camera, const Vec2& pixel);
Vec2 bentBack(const Camera& camera, const Vec2& straight);

} // namespace patina
