// How a point that lies on the surface moves with the tip.
#pragma once

#include <array>

#include "core/types.h"
#include "field/sampling/four.h"

namespace patina {

// A matrix by its columns, {0, x, y, z} each, as nodes of a field are laid out.
struct SurfaceJacobian {
  std::array<Float4, 3> column{};

  static SurfaceJacobian of(const Eigen::Matrix3d& m) noexcept {
    const auto of_axis = [&](Eigen::Index j) {
      return Float4{0, static_cast<float>(m(0, j)), static_cast<float>(m(1, j)),
                    static_cast<float>(m(2, j))};
    };
    return {{of_axis(0), of_axis(1), of_axis(2)}};
  }
  Vec3 operator*(const Vec3& v) const noexcept {
    const Float4 sum = static_cast<float>(v.x()) * column[0] +
                       static_cast<float>(v.y()) * column[1] +
                       static_cast<float>(v.z()) * column[2];
    return Vec3(sum[1], sum[2], sum[3]);
  }
};

} // namespace patina
