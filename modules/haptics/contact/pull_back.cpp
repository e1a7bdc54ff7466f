#include "haptics/contact/pull_back.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

// Nearer to the surface than this [voxel] its curvature changes nothing that the voxel resolves.
constexpr double kNear = 1e-3;
constexpr double kLeast = 0.25; // of 1 + phi times a curvature

// Its inverse in the plane across n, of a symmetric matrix whose eigenvalues there are held up.
Eigen::Matrix3d heldInverse(const Eigen::Matrix3d& stretch, const Vec3& n) noexcept {
  const Vec3 s = n.unitOrthogonal(), t = n.cross(s);
  const double ss = s.dot(stretch * s), st = s.dot(stretch * t), tt = t.dot(stretch * t);
  const double mean = 0.5 * (ss + tt), half = std::hypot(0.5 * (ss - tt), st);
  const double angle = 0.5 * std::atan2(2 * st, ss - tt);
  const Vec3 most = std::cos(angle) * s + std::sin(angle) * t, least = n.cross(most);
  return 1 / std::max(kLeast, mean + half) * most * most.transpose() +
         1 / std::max(kLeast, mean - half) * least * least.transpose();
}

Eigen::Matrix3d jacobianOf(const FieldSampler& sampler, const Contact& contact) noexcept {
  if (contact.walls > 2) return Eigen::Matrix3d::Zero();
  if (contact.walls == 2) {
    const Vec3 line = contact.wall[0].normal.cross(contact.wall[1].normal);
    return 1 / line.squaredNorm() * line * line.transpose();
  }
  // Relief leans the normal; the surface that it lies on does not.
  Vec3 n = contact.normal;
  if (!contact.slope.isZero(0)) n = std::sqrt(1 + contact.slope.squaredNorm()) * n + contact.slope;
  const double per_voxel = 1 / sampler.grid().voxel;
  return closestPointJacobian(sampler, per_voxel * (contact.surface - sampler.grid().origin), n,
                              per_voxel * (contact.tip - contact.surface).dot(n));
}

} // namespace

Eigen::Matrix3d closestPointJacobian(const FieldSampler& sampler, const Vec3& q, const Vec3& n,
                                     double phi) noexcept {
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - n * n.transpose();
  if (std::abs(phi) < kNear) return flat;
  const Eigen::Matrix3d turn = sampler.turnAtGrid(q);
  const Eigen::Matrix3d both = 0.5 * phi * (turn + turn.transpose());
  const Vec3 out = both * n;
  const double out_out = out.dot(n);
  const Eigen::Matrix3d bent = both - (out - out_out * n) * n.transpose() - n * out.transpose();
  // In the plane the inverse of a matrix is its trace less itself, over its determinant.
  const double trace = both.trace() - out_out, squares = 0.5 * (trace * trace - bent.squaredNorm()),
               determinant = 1 + trace + squares;
  const bool plain = trace >= 2 * kLeast - 2 &&
                     determinant >= kLeast * (2 + trace) - kLeast * kLeast; // both eigenvalues
  if (!plain) return heldInverse(flat + bent, n);
  return 1 / determinant * ((1 + trace) * flat - bent);
}

Vec3 pulledBack(const FieldSampler& sampler, Contact& contact, const Vec3& along) noexcept {
  if (along.isZero(0)) return Vec3::Zero();
  if (!contact.jacobian) contact.jacobian = jacobianOf(sampler, contact);
  return *contact.jacobian * along;
}

} // namespace patina
