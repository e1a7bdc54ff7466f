// How a point that lies on the surface moves with the tip.
#pragma once

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
  explicit SurfaceJacobian(const Eigen::Matrix3d& whole) noexcept { columns_ << whole, 0, 0, 0; }

  Vec3 operator*(const Vec3& v) const noexcept { return columns_.topRows<3>() * v; }

 private:
  Eigen::Matrix<double, 4, 3> columns_; // the last row is 0: a column is one write
};

} // namespace patina
