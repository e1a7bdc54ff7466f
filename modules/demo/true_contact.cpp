#include "demo/true_contact.h"

namespace patina {
namespace {

constexpr int kLooks = 8;        // to each side, before the best one is followed
constexpr double kFinest = 1e-9; // [m]

} // namespace

Vec3 trueForce(const HeightOver& surface, const Vec3& tip, double stiffness, double reach) {
  const Vec2 under = tip.head<2>();
  if (tip.z() >= surface(under)) return Vec3::Zero();
  const auto pointAt = [&](const Vec2& place) {
    return Vec3(place.x(), place.y(), surface(place));
  };
  Vec3 best = pointAt(under);
  double least = (best - tip).squaredNorm();
  const auto look = [&](const Vec2& place) {
    const Vec3 point = pointAt(place);
    const double square = (point - tip).squaredNorm();
    if (!(square < least)) return false;
    least = square;
    best = point;
    return true;
  };
  double step = reach / kLooks;
  for (int i = -kLooks; i <= kLooks; ++i)
    for (int j = -kLooks; j <= kLooks; ++j) look(under + step * Vec2(i, j));
  while (step > kFinest) {
    const Vec2 here = best.head<2>();
    bool nearer = false;
    for (const Vec2& way : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
      nearer |= look(here + step * way);
    if (!nearer) step /= 2;
  }
  return stiffness * (best - tip);
}

} // namespace patina
