// Projection of points to pixels and of pixels to rays (A04), for every lens model.
#pragma once

#include <optional>

#include "acquisition/values/camera.h"

namespace patina {

// Projects a point of the camera's frame in front of the camera to a pixel.
Vec2 pixelOf(const Camera& camera, const Vec3& in_camera);

// Distorts a point of the plane z = 1 by the lens model.
Vec2 distorted(const Camera& camera, const Vec2& flat);
// The same with its derivative by `flat`.
struct DistortedPoint {
  Vec2 place;
  Eigen::Matrix2d jacobian;
};
DistortedPoint distortedWithJacobian(const Camera& camera, const Vec2& flat);

// Returns the point of the plane z = 1 for a pixel, by Newton's method from `start` (default: the
// pinhole's point) to 1e-10. Returns nullopt if there is none: beyond 89 degrees from the axis, and
// where the lens model is not invertible.
std::optional<Vec2> normalizedPoint(const Camera& camera, const Vec2& pixel,
                                    const Vec2* start = nullptr);

// Remove the distortion from a pixel, and add it.
std::optional<Vec2> undistortedPoint(const Camera& camera, const Vec2& pixel);
Vec2 distortedPoint(const Camera& camera, const Vec2& straight);

} // namespace patina
