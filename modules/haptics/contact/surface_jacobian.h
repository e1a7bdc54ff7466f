// Derivative of a surface point with respect to the tip.
#pragma once

#include "core/types.h"
#include "field/sampling/band_cell.h"

namespace patina {

// J of the closest point c (F6), from the Hessian H, projected across n, of a level set sampled
// `iso` in front of c and `depth` in front of the tip:
//   J = (P - iso H) (I - depth H)^-1,  P = I - n n^T.
// H is constant per cell, with an error O(h), in single precision as the nodes are, for a phi with
// |grad phi| = 1 per voxel. J is symmetric; the tip gradient of a surface quantity is J times its
// surface gradient. Singular values are clamped to 0, as for an edge, and 4: they diverge towards a
// medial axis.
class SurfaceJacobian {
 public:
  // n: unit; lengths in voxels.
  SurfaceJacobian(const BandCell& cell, const Vec3& n, double depth, double iso) noexcept;
  explicit SurfaceJacobian(const Eigen::Matrix3d& whole) noexcept { columns_ << whole, 0, 0, 0; }

  Vec3 operator*(const Vec3& v) const noexcept { return columns_.topRows<3>() * v; }

 private:
  Eigen::Matrix<double, 4, 3> columns_; // the last row is 0, so that a column is one store
};

} // namespace patina
