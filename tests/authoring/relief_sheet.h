// A sheet that fills the image, for tests of relief.
#pragma once

#include "authoring/relief_shapes.h"

namespace patina::test {

inline constexpr double kWidth = 0.1;
inline constexpr int kSize = 256;
inline constexpr double kTexel = kWidth / kSize;

// The sheet may be rotated, sheared or stretched in the image.
struct Sheet {
  TriangleMesh mesh = sheet(kWidth, kWidth, 8);
  TextureLayout layout;

  explicit Sheet(const Eigen::Matrix2d& uv_from_side = Eigen::Matrix2d::Identity()) {
    layout.uvs = uvsBy(mesh, [&](const Vec3& p) {
      return Vec2(uv_from_side * p.head<2>() / kWidth + Vec2::Constant(0.5));
    });
  }
};

inline Eigen::Matrix2d matrix(double a, double b, double c, double d) {
  Eigen::Matrix2d m;
  m << a, b, c, d;
  return m;
}

} // namespace patina::test
