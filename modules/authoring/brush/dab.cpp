#include "authoring/brush/dab.h"

#include <algorithm>
#include <cmath>

#include "authoring/brush/painter.h"

namespace patina {

double brushWeight(const Brush& brush, double distance, double radius) {
  if (!(distance < radius)) return 0;
  const double x = distance / radius;
  switch (brush.shape) {
  case BrushShape::cone:
    return std::pow(1 - x, brush.falloff);
  case BrushShape::smooth:
    return std::pow(1 - x * x, brush.falloff);
  case BrushShape::power:
    break;
  }
  return 1 - std::pow(x, brush.falloff);
}

double brushRadius(const Brush& brush, double force) {
  return std::clamp(brush.radius + brush.radius_per_force * std::abs(force), brush.min_radius,
                    std::max(brush.min_radius, brush.max_radius));
}

double Dab::boundingRadius() const {
  return std::max(radius_from, radius_to) + 0.5 * (to - from).norm();
}

Dab Dab::in(const Pose& other_from_world) const {
  return {other_from_world * from, other_from_world * to, radius_from, radius_to, front};
}

double weightAt(const Dab& dab, const Brush& brush, const Vec3& p) {
  const Vec3 along = dab.to - dab.from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - dab.from).dot(along) / length2, 0.0, 1.0) : 1.0;
  const double distance = (p - (dab.from + t * along)).norm();
  return brushWeight(brush, distance, dab.radius_from + t * (dab.radius_to - dab.radius_from));
}

} // namespace patina
