#include "acquisition/tracking/lens.h"

namespace patina {
namespace {

struct Bend {
  double radial;
  Vec2 tangential;
};

Bend bendAt(const Camera& camera, const Vec2& p) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double r2 = p.squaredNorm(), xy = 2 * p.x() * p.y();
  return {1 + r2 * (k1 + r2 * (k2 + r2 * k3)),
          {p1 * xy + p2 * (r2 + 2 * p.x() * p.x()), p1 * (r2 + 2 * p.y() * p.y()) + p2 * xy}};
}

Vec2 toPixel(const Camera& camera, const Vec2& p) {
  return {camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy};
}

Vec2 toPlane(const Camera& camera, const Vec2& p) {
  return {(p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy};
}

} // namespace

Vec2 distorted(const Camera& camera, const Vec2& flat) {
  const Bend bend = bendAt(camera, flat);
  return bend.radial * flat + bend.tangential;
}

Vec2 pixelOf(const Camera& camera, const Vec3& in_camera) {
  return toPixel(camera, distorted(camera, in_camera.hnormalized()));
}

Vec2 flatOf(const Camera& camera, const Vec2& pixel) {
  const Vec2 seen = toPlane(camera, pixel);
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  Vec2 flat = seen;
  double off = (distorted(camera, flat) - seen).norm();
  // Newton's, halved where a step leads away.
  for (int i = 0; i < 100 && off > 1e-13; ++i) {
    const double x = flat.x(), y = flat.y(), r2 = flat.squaredNorm(),
                 radial = bendAt(camera, flat).radial, per_r2 = k1 + r2 * (2 * k2 + 3 * r2 * k3);
    Eigen::Matrix2d change;
    change << radial + 2 * x * x * per_r2 + 2 * p1 * y + 6 * p2 * x,
        2 * x * y * per_r2 + 2 * p1 * x + 2 * p2 * y, 0,
        radial + 2 * y * y * per_r2 + 6 * p1 * y + 2 * p2 * x;
    change(1, 0) = change(0, 1);
    Vec2 step = change.inverse() * (seen - distorted(camera, flat));
    bool nearer = false;
    for (int halved = 0; halved < 20 && !nearer; ++halved, step /= 2) {
      const double now = (distorted(camera, Vec2(flat + step)) - seen).norm();
      if ((nearer = now < off)) {
        flat += step;
        off = now;
      }
    }
    if (!nearer) break;
  }
  return flat;
}

Vec2 straightened(const Camera& camera, const Vec2& pixel) {
  return toPixel(camera, flatOf(camera, pixel));
}

Vec2 bentBack(const Camera& camera, const Vec2& straight) {
  return toPixel(camera, distorted(camera, toPlane(camera, straight)));
}

} // namespace patina
