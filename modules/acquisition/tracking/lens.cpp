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
  Vec2 flat = seen;
  for (int i = 0; i < 100; ++i) {
    const Bend bend = bendAt(camera, flat);
    const Vec2 next = (seen - bend.tangential) / bend.radial;
    const double step = (next - flat).squaredNorm();
    flat = next;
    if (!(step > 1e-20)) break;
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
