// How a point that lies on the surface moves with the tip.
#pragma once

#include <array>

#include "core/types.h"
#include "field/build/band_cell.h"

namespace patina {

// J of the closest point c (F6), by the curvature H, across n, of a level set that was seen `iso`
// in front of c and `depth` in front of the tip:
//   J = (P - iso H) (I - depth H)^-1,  P = I - n n^T.
// H is that of one cell, O(h) of itself, in single precision as the nodes are, of a phi that grows
// by 1 a voxel. Symmetric; the gradient by the tip of what is read at c is J times its gradient
// over the surface. Its stretches are held within 0, as where c stays on an edge, and 4: towards a
// medial axis they grow beyond bounds.
class SurfaceJacobian {
 public:
  // n: unit; lengths in voxels.
  SurfaceJacobian(const BandCell& cell, const Vec3& n, double depth, double iso) noexcept;
  explicit SurfaceJacobian(const Eigen::Matrix3d& whole) noexcept
      : column_{lanesOf(whole.col(0)), lanesOf(whole.col(1)), lanesOf(whole.col(2))} {}

  Vec3 operator*(const Vec3& v) const noexcept {
    const Float4 sum = static_cast<float>(v.x()) * column_[0] +
                       static_cast<float>(v.y()) * column_[1] +
                       static_cast<float>(v.z()) * column_[2];
    return Vec3(sum[1], sum[2], sum[3]);
  }

 private:
  static Float4 lanesOf(const Vec3& v) noexcept {
    return Float4{0, static_cast<float>(v.x()), static_cast<float>(v.y()),
                  static_cast<float>(v.z())};
  }

  std::array<Float4, 3> column_; // {0, x, y, z}
};

} // namespace patina
