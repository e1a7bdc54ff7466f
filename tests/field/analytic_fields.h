// Shapes with a known distance, and fields of them.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "field/store/field_grid.h"
#include "field/store/surface_field.h"

namespace patina::test {

using Distance = std::function<double(const Vec3&)>;

inline Distance sphereDistance(double radius) {
  return [radius](const Vec3& p) { return p.norm() - radius; };
}

inline Distance torusDistance(double major, double minor) {
  return [=](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - major, p.z()) - minor; };
}

inline Distance boxDistance(const Vec3& half) {
  return [half](const Vec3& p) {
    const Vec3 d = p.cwiseAbs() - half;
    return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
  };
}

inline Box3 cube(double half) {
  return {Vec3::Constant(-half), Vec3::Constant(half)};
}

inline FieldGrid cubeGrid(double half, int resolution, double band = 8) {
  return gridAround(cube(half),
                    FieldSpec{.resolution = resolution, .voxel = std::nullopt, .band = band});
}

inline std::shared_ptr<const SurfaceField> sampledField(const Distance& distance,
                                                        const FieldGrid& grid, double band = 8) {
  return withSamples(std::make_shared<const SurfaceField>(sampleFunction(distance, grid, band)));
}

inline Vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (;;) {
    const Vec3 v(normal(random), normal(random), normal(random));
    if (v.norm() > 1e-3) return v.normalized();
  }
}

inline double angleBetween(const Vec3& a, const Vec3& b) { // [rad], exact for small angles
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

} // namespace patina::test
