#include "haptics/contact/surface_jacobian.h"

#include <algorithm>
#include <cmath>

#define PATINA_KERNEL jacobian_plain
#include "haptics/contact/jacobian_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace jacobian_avx2 {
bool jacobianOf(const Float4* low, float x, float y, float z, const double* n, double depth,
                double iso, Float4* columns) noexcept; // jacobian_avx2.cpp
}
namespace {

static_assert(kNodeRow == kRow && kNodeLayer == kLayer);

JacobianOfCell jacobianOfThisProcessor() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return &jacobian_avx2::jacobianOf;
#endif
  return &jacobian_plain::jacobianOf;
}
const JacobianOfCell kJacobian = jacobianOfThisProcessor();

// By the curvatures themselves, in their own directions, each held within what J may be.
Eigen::Matrix3d heldJacobian(const std::array<Float4, 3>& column, const Vec3& n, double depth,
                             double iso) noexcept {
  Eigen::Matrix3d curvature;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j)
      curvature(i, j) = static_cast<double>(column[static_cast<std::size_t>(j)][i + 1]);
  const Vec3 s = n.unitOrthogonal(), t = n.cross(s);
  const double ss = s.dot(curvature * s), st = s.dot(curvature * t), tt = t.dot(curvature * t);
  const double mean = 0.5 * (ss + tt), half = std::hypot(0.5 * (ss - tt), st);
  const double angle = 0.5 * std::atan2(2 * st, ss - tt);
  const Vec3 most = std::cos(angle) * s + std::sin(angle) * t, least = n.cross(most);
  const auto stretch = [&](double bend) {
    constexpr auto kMost = static_cast<double>(kMostStretch);
    const double by = 1 - depth * bend, part = std::max(0.0, 1 - iso * bend);
    return part < kMost * by ? part / by : kMost;
  };
  return stretch(mean + half) * most * most.transpose() +
         stretch(mean - half) * least * least.transpose();
}

} // namespace

SurfaceJacobian::SurfaceJacobian(const BandCell& cell, const Vec3& n, double depth,
                                 double iso) noexcept {
  if (!kJacobian(reinterpret_cast<const Float4*>(cell.node), cell.fx, cell.fy, cell.fz, n.data(),
                 depth, iso, column_.data())) [[unlikely]]
    *this = SurfaceJacobian(heldJacobian(column_, n, depth, iso));
}

} // namespace patina
