#include "haptics/pull_back.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kStep = 0.5; // voxels to either side
// Nearer to the surface than this [voxel] its curvature changes nothing that the voxel resolves.
constexpr double kNear = 1e-3;

} // namespace

Vec3 pulledBack(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double phi,
                const Vec3& along) noexcept {
  const Vec3 flat = along - along.dot(n) * n;
  const double length = flat.norm();
  if (!(length > 0) || std::abs(phi) < kNear) return flat;
  const Vec3 step = kStep / length * flat;
  const GridSample ahead = sampler.atGrid(q + step), behind = sampler.atGrid(q - step);
  if (ahead.region != FieldRegion::band || behind.region != FieldRegion::band) return flat;
  const Vec3 turn = ahead.gradient - behind.gradient;
  const Vec3 change = phi * length / (2 * kStep) * (turn - turn.dot(n) * n);
  return change.squaredNorm() < length * length ? Vec3(flat - change) : flat;
}

} // namespace patina
