#include "acquisition/tracking/lens.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kMaxPlaneRadius = 57.29; // tan 89 degrees, on the plane z = 1
constexpr double kPlaneTolerance = 1e-10; // on the plane z = 1

Vec2 toPixel(const Camera& camera, const Vec2& p) {
  return {camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy};
}

Vec2 toPlane(const Camera& camera, const Vec2& p) {
  return {(p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy};
}

// Returns the homography of a sensor tilted about x and then about y (OpenCV's tau).
Eigen::Matrix3d tiltOf(double about_x, double about_y) {
  const double cx = std::cos(about_x), sx = std::sin(about_x), cy = std::cos(about_y),
               sy = std::sin(about_y);
  Eigen::Matrix3d x, y, onto_plane;
  x << 1, 0, 0, 0, cx, sx, 0, -sx, cx;
  y << cy, 0, -sy, 0, 1, 0, sy, 0, cy;
  const Eigen::Matrix3d turn = y * x;
  onto_plane << turn(2, 2), 0, -turn(0, 2), 0, turn(2, 2), -turn(1, 2), 0, 0, 1;
  return onto_plane * turn;
}

// Brown 1966 with the terms of LensModel::brown; `jacobian` may be null.
Vec2 brownMap(const Camera& camera, const Vec2& p, Eigen::Matrix2d* jacobian) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y] = camera.distortion;
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm(), xy = 2 * x * y;
  const double above = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)),
               below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6)), radial = above / below;
  Vec2 place = radial * p + Vec2(p1 * xy + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + p2 * xy) +
               Vec2(r2 * (s1 + r2 * s2), r2 * (s3 + r2 * s4));
  if (jacobian) {
    const double above_per_r2 = k1 + r2 * (2 * k2 + 3 * r2 * k3),
                 below_per_r2 = k4 + r2 * (2 * k5 + 3 * r2 * k6),
                 per_r2 = (above_per_r2 - radial * below_per_r2) / below;
    const Vec2 prism(2 * (s1 + 2 * r2 * s2), 2 * (s3 + 2 * r2 * s4));
    const double mixed = 2 * x * y * per_r2 + 2 * p1 * x + 2 * p2 * y;
    *jacobian << radial + 2 * x * x * per_r2 + 2 * p1 * y + 6 * p2 * x, mixed, mixed,
        radial + 2 * y * y * per_r2 + 6 * p1 * y + 2 * p2 * x;
    *jacobian += prism * p.transpose();
  }
  if (tau_x == 0 && tau_y == 0) return place;
  const Eigen::Matrix3d tilt = tiltOf(tau_x, tau_y);
  const Vec3 tilted = tilt * place.homogeneous();
  place = tilted.hnormalized();
  if (jacobian) {
    const Eigen::Matrix2d slope =
        (tilt.topLeftCorner<2, 2>() - place * tilt.block<1, 2>(2, 0)) / tilted.z();
    *jacobian = slope * *jacobian;
  }
  return place;
}

// Kannala & Brandt 2006; `jacobian` may be null.
Vec2 fisheyeMap(const Camera& camera, const Vec2& p, Eigen::Matrix2d* jacobian) {
  const double* k = camera.distortion.data();
  const double r = p.norm(), angle = std::atan(r), a2 = angle * angle;
  const double seen = angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
  const double scale = r > 1e-8 ? seen / r : 1;
  if (jacobian) {
    const double per_angle =
        1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])));
    const Vec2 along = r > 1e-8 ? Vec2(p / r) : Vec2(Vec2::UnitX());
    *jacobian = scale * Eigen::Matrix2d::Identity() +
                (per_angle / (1 + r * r) - scale) * along * along.transpose();
  }
  return scale * p;
}

Vec2 mapThroughLens(const Camera& camera, const Vec2& flat, Eigen::Matrix2d* jacobian) {
  return camera.lens == LensModel::fisheye ? fisheyeMap(camera, flat, jacobian)
                                           : brownMap(camera, flat, jacobian);
}

} // namespace

Vec2 distorted(const Camera& camera, const Vec2& flat) {
  return mapThroughLens(camera, flat, nullptr);
}

DistortedPoint distortedWithJacobian(const Camera& camera, const Vec2& flat) {
  DistortedPoint point;
  point.place = mapThroughLens(camera, flat, &point.jacobian);
  return point;
}

Vec2 pixelOf(const Camera& camera, const Vec3& in_camera) {
  return toPixel(camera, distorted(camera, in_camera.hnormalized()));
}

std::optional<Vec2> normalizedPoint(const Camera& camera, const Vec2& pixel, const Vec2* start) {
  const Vec2 seen = toPlane(camera, pixel);
  Vec2 flat = start ? *start : seen;
  DistortedPoint now = distortedWithJacobian(camera, flat);
  double off = (now.place - seen).norm();
  // The step is halved until the residual decreases.
  for (int i = 0; i < 100 && off > 1e-13; ++i) {
    Vec2 step = now.jacobian.inverse() * (seen - now.place);
    bool nearer = false;
    for (int halved = 0; halved < 20 && !nearer; ++halved, step /= 2) {
      const Vec2 there = flat + step;
      const double left = (distorted(camera, there) - seen).norm();
      if ((nearer = left < off)) {
        flat = there;
        off = left;
      }
    }
    if (!nearer) break;
    now = distortedWithJacobian(camera, flat);
  }
  const bool found = off <= kPlaneTolerance * std::min(1., now.jacobian.norm());
  const bool folded = !(now.jacobian.determinant() > 0);
  const bool sideways = camera.lens == LensModel::fisheye && !(flat.norm() < kMaxPlaneRadius);
  if (!found || folded || sideways) return std::nullopt;
  return flat;
}

std::optional<Vec2> undistortedPoint(const Camera& camera, const Vec2& pixel) {
  const std::optional<Vec2> flat = normalizedPoint(camera, pixel);
  return flat ? std::optional(toPixel(camera, *flat)) : std::nullopt;
}

Vec2 distortedPoint(const Camera& camera, const Vec2& straight) {
  return toPixel(camera, distorted(camera, toPlane(camera, straight)));
}

} // namespace patina
