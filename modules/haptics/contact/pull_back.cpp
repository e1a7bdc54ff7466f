#include "haptics/contact/pull_back.h"

#include <cmath>

namespace patina {

SurfaceJacobian closestPointJacobian(const FieldSampler& sampler, const Vec3& q, const Vec3& n,
                                     double phi) noexcept {
  if (BandCell cell; sampler.cellAt(q, cell)) return SurfaceJacobian(cell, n, -phi, 0);
  return SurfaceJacobian(Eigen::Matrix3d::Identity() - n * n.transpose());
}

SurfaceJacobian jacobianOf(const FieldSampler& sampler, const Contact& contact) noexcept {
  if (contact.walls > 2) return SurfaceJacobian(Eigen::Matrix3d::Zero());
  if (contact.walls == 2) {
    const Vec3 line = contact.wall[0].normal.cross(contact.wall[1].normal);
    return SurfaceJacobian(1 / line.squaredNorm() * line * line.transpose());
  }
  // Relief tilts the contact normal; the surface below keeps its own.
  Vec3 n = contact.normal;
  if (!contact.slope.isZero(0)) n = std::sqrt(1 + contact.slope.squaredNorm()) * n + contact.slope;
  return closestPointJacobian(sampler, sampler.toGrid(contact.surface), n,
                              sampler.perVoxel() * (contact.tip - contact.surface).dot(n));
}

} // namespace patina
