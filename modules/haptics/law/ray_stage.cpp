#include "haptics/law/ray_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/law/contact_memory.h"

namespace patina {
namespace {

constexpr double kMinGradient = 0.1; // K05

// In voxels; single-precision values near the surface have an error of some 2e-7.
constexpr double kRootTolerance = 1e-6;
// A step after the second sample leaves an error of about |f| times the slope's variation along
// the ray. The slope of a distance is 1 except across creases, which the secant's deviation from 1
// reveals; trilinear interpolation adds some h / 2R.
constexpr double kStepTolerance = 5e-7;
constexpr double kMinVariation = 0.01;
constexpr int kMaxRaySamples = 64;

struct RayRoot {
  bool found = false;
  double s = 0; // distance along the ray [voxels]
  int samples = 0;
};

// First s > 0 with phi(q + s n) = iso, for phi(q) = iso - distance < iso and |n| = 1. Starts at the
// lower bound `distance`, marches by at most max(1 voxel, |phi - iso|) to a bracket, then uses
// safeguarded secants. Fails beyond 4 distance + 8 voxels or after kMaxRaySamples.
RayRoot rayRoot(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double distance,
                double iso) noexcept {
  RayRoot root;
  const double s_max = 4 * distance + 8;
  double inside = 0; // largest s known to be inside
  double outside = -1;
  double s_last = 0;
  double f_last = -distance;
  double s = distance;
  while (root.samples < kMaxRaySamples) {
    const double f = sampler.phiAtGrid(q + s * n) - iso;
    ++root.samples;
    // Returns s without a correction, so that later code does not wait for this sample.
    if (std::abs(f) < kRootTolerance) return {true, s, root.samples};
    // Reciprocal of the slope: the only division in this loop.
    const double per_slope = (s - s_last) / (f - f_last);
    double next = s - f * per_slope;
    const double variation = std::max(std::abs(per_slope - 1), kMinVariation);
    if (root.samples > 1 && std::abs(f) * variation < kStepTolerance && next > inside)
      return {true, next, root.samples};
    if (f < 0) {
      inside = s;
      // At least the distance known to be free, but no step across a thin gap.
      if (outside < 0) next = s + std::min(std::max(next - s, -f), std::max(1.0, -f));
    } else {
      outside = s;
    }
    if (outside >= 0 && !(next > inside && next < outside)) next = 0.5 * (inside + outside);
    s_last = s;
    f_last = f;
    s = next;
    if (!(s <= s_max)) return root;
    if (s == s_last) return {s > 0, s, root.samples}; // no number is left inside the bracket
  }
  return root;
}

Vec3 directionAt(const GridSample& sample, const ContactMemory& memory) noexcept {
  const double squared = sample.gradient.squaredNorm();
  if (squared >= kMinGradient * kMinGradient) return sample.gradient / std::sqrt(squared);
  return memory.contact.c ? memory.ray.normal : Vec3::Zero();
}

} // namespace

RayStage::RayStage(const FieldSampler& sampler, double iso)
    : sampler_(sampler), voxel_(sampler.grid().voxel), iso_(iso * sampler_.perVoxel()) {}

void RayStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const Vec3 q = sampler_.toGrid(contact.tip);
  const GridSample sample = sampler_.atGrid(q);
  contact.samples = 1;
  contact.clearance = memory.contact.clearance = sample.phi - iso_;
  std::optional<Vec3>& last = memory.contact.c;
  if (!(contact.clearance < 0)) {
    last.reset();
    return;
  }
  contact.touching = true;
  contact.deep = sample.region == FieldRegion::interior;
  contact.normal = directionAt(sample, memory);
  double depth = -contact.clearance;
  if (!contact.normal.isZero()) {
    const RayRoot root = rayRoot(sampler_, q, contact.normal, depth, iso_);
    contact.samples += root.samples;
    // The slope of a distance is 1. At a crease the blended gradient is shorter, and dividing by it
    // would move the contact point far beyond the part.
    if (root.found) depth = root.s;
  }
  contact.depth = depth * voxel_;
  contact.frictionless_point = contact.tip + contact.depth * contact.normal;
  contact.vcp = contact.frictionless_point;
  contact.surface = contact.frictionless_point - iso_ * voxel_ * contact.normal;
  contact.wall[0] = {contact.normal, contact.depth};
  contact.walls = 1;
  if (last) {
    contact.displacement = contact.frictionless_point - *last;
    contact.snap = contact.normal.dot(memory.ray.normal) < 0;
    if (contact.snap) contact.slip_jump = contact.displacement.norm();
  }
  last = contact.frictionless_point;
  memory.ray.normal = contact.normal;
}

} // namespace patina
