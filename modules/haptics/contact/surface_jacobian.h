// How a point that lies on the surface moves with the tip.
#pragma once

#include "core/types.h"
#include "field/sampling/four.h"

namespace patina {

// A matrix by its columns, {0, x, y, z} each, as nodes of a field are laid out.
struct SurfaceJacobian {
  Float4 x{}, y{}, z{};

  static SurfaceJacobian of(const Eigen::Matrix3d& m) noexcept {
    const auto column = [&](Eigen::Index j) {
      return Float4{0, static_cast<float>(m(0, j)), static_cast<float>(m(1, j)),
                    static_cast<float>(m(2, j))};
    };
    return {column(0), column(1), column(2)};
  }
  Vec3 operator*(const Vec3& v) const noexcept {
    const Float4 sum = static_cast<float>(v.x()) * x + static_cast<float>(v.y()) * y +
                       static_cast<float>(v.z()) * z;
    return Vec3(sum[1], sum[2], sum[3]);
  }
};

} // namespace patina
