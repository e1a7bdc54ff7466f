#include "haptics/contact/surface_jacobian.h"

#include "core/processor.h"

#define PATINA_KERNEL jacobian_plain
#include "haptics/contact/jacobian_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace jacobian_avx2 {
void jacobianOf(const Float4* low, float x, float y, float z, const double* n, double depth,
                double iso, double* columns) noexcept; // jacobian_avx2.cpp
}
namespace {

static_assert(jacobian_plain::kNodeRow == kRow && jacobian_plain::kNodeLayer == kLayer);

auto jacobianOfThisProcessor() {
#if defined(__x86_64__)
  if (hasAvx2()) return &jacobian_avx2::jacobianOf;
#endif
  return &jacobian_plain::jacobianOf;
}

} // namespace

SurfaceJacobian::SurfaceJacobian(const BandCell& cell, const Vec3& n, double depth,
                                 double iso) noexcept {
  static const auto kJacobian = jacobianOfThisProcessor();
  kJacobian(reinterpret_cast<const Float4*>(cell.node), cell.fx, cell.fy, cell.fz, n.data(), depth,
            iso, columns_.data());
}

} // namespace patina
