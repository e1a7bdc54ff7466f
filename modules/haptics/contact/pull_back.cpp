#include "haptics/contact/pull_back.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kStep = 0.5; // voxels to either side
// Nearer to the surface than this [voxel] its curvature changes nothing that the voxel resolves.
constexpr double kNear = 1e-3;
constexpr double kLeast = 0.25; // of 1 + phi times curvature

} // namespace

Vec3 pulledBack(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double phi,
                const Vec3& along) noexcept {
  const Vec3 flat = along - along.dot(n) * n;
  const double length = flat.norm();
  if (!(length > 0) || std::abs(phi) < kNear) return flat;
  const Vec3 direction = 1 / length * flat;
  const GridSample ahead = sampler.atGrid(q + kStep * direction),
                   behind = sampler.atGrid(q - kStep * direction);
  if (ahead.region != FieldRegion::band || behind.region != FieldRegion::band) return flat;
  const Vec3 turn = 1 / (2 * kStep) * (ahead.gradient - behind.gradient);
  const Vec3 bent = turn - turn.dot(n) * n; // H direction
  return flat - phi * length / std::max(kLeast, 1 + phi * direction.dot(bent)) * bent;
}

Vec3 pulledBack(const FieldSampler& sampler, const Contact& contact, const Vec3& along) noexcept {
  if (contact.walls > 2 || along.isZero(0)) return Vec3::Zero();
  if (contact.walls == 2) {
    const Vec3 line = contact.wall[0].normal.cross(contact.wall[1].normal);
    return along.dot(line) / line.squaredNorm() * line;
  }
  // Relief leans the normal; the surface that it lies on does not.
  const Vec3 n = std::sqrt(1 + contact.slope.squaredNorm()) * contact.normal + contact.slope;
  const double per_voxel = 1 / sampler.grid().voxel;
  return pulledBack(sampler, per_voxel * (contact.surface - sampler.grid().origin), n,
                    per_voxel * (contact.tip - contact.surface).dot(n), along);
}

} // namespace patina
