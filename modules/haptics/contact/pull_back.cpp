#include "haptics/contact/pull_back.h"

#include <algorithm>
#include <cmath>

#define PATINA_KERNEL jacobian_plain
#include "haptics/contact/jacobian_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace jacobian_avx2 {
bool jacobianOf(const CellCurvature& cell, Float4* inverse,
                Float4* both) noexcept; // jacobian_avx2.cpp
}
namespace {

CellJacobian jacobianOfThisProcessor() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return &jacobian_avx2::jacobianOf;
#endif
  return &jacobian_plain::jacobianOf;
}

// Nearer to the surface than this [voxel] its curvature changes nothing that the voxel resolves.
constexpr double kNear = 1e-3;
constexpr auto kLeast = static_cast<double>(kLeastStretch);

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

Eigen::Matrix3d matrixOf(const Float4* columns) noexcept {
  Eigen::Matrix3d m;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) m(i, j) = static_cast<double>(columns[j][i + 1]);
  return m;
}

} // namespace

SurfaceJacobian closestPointJacobian(const FieldSampler& sampler, const Vec3& q, const Vec3& n,
                                     double phi) noexcept {
  static const CellJacobian kJacobian = jacobianOfThisProcessor();
  const auto flat = [&] {
    return Eigen::Matrix3d(Eigen::Matrix3d::Identity() - n * n.transpose());
  };
  BandCell cell;
  if (std::abs(phi) < kNear || !sampler.cellAt(q, cell)) return SurfaceJacobian::of(flat());
  SurfaceJacobian jacobian;
  std::array<Float4, 3> both;
  const CellCurvature curvature{
      reinterpret_cast<const Float4*>(cell.node),
      kRow,
      kLayer,
      {cell.fx, cell.fy, cell.fz},
      Float4{0, static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())},
      static_cast<float>(phi)};
  if (!kJacobian(curvature, jacobian.column.data(), both.data())) [[unlikely]] {
    const Eigen::Matrix3d across = flat();
    return SurfaceJacobian::of(heldInverse(across + across * matrixOf(both.data()) * across, n));
  }
  return jacobian;
}

SurfaceJacobian jacobianOf(const FieldSampler& sampler, const Contact& contact) noexcept {
  if (contact.walls > 2) return {};
  if (contact.walls == 2) {
    const Vec3 line = contact.wall[0].normal.cross(contact.wall[1].normal);
    return SurfaceJacobian::of(1 / line.squaredNorm() * line * line.transpose());
  }
  // Relief leans the normal; the surface that it lies on does not.
  Vec3 n = contact.normal;
  if (!contact.slope.isZero(0)) n = std::sqrt(1 + contact.slope.squaredNorm()) * n + contact.slope;
  return closestPointJacobian(sampler, sampler.toGrid(contact.surface), n,
                              sampler.perVoxel() * (contact.tip - contact.surface).dot(n));
}

} // namespace patina
