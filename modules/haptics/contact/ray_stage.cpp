#include "haptics/contact/ray_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/contact/contact_memory.h"

namespace patina {
namespace {

constexpr double kMinGradient = 0.1; // K05

// Voxels; values near the surface are good to some 2e-7 (float).
constexpr double kRootTolerance = 1e-6;
// A step from the second sample on leaves about |f| times the variation of the slope along the ray.
// The slope of a distance along its own direction is 1, except across creases, where the secant's
// difference from 1 tells; a trilinear value adds some h / 2R.
constexpr double kStepTolerance = 5e-7;
constexpr double kLeastVariation = 0.01;
constexpr int kMaxRaySamples = 64;

struct RayRoot {
  bool found = false;
  double s = 0; // voxels along the direction
  int samples = 0;
};

// First s > 0 with phi(q + s n) = iso, for phi(q) = iso - distance < iso and |n| = 1. The distance
// of a signed distance field is a lower bound of s, so the search starts there; it goes on in steps
// of at most max(1 voxel, |phi - iso|) until the surface is bracketed, then by safeguarded secants.
// Gives up beyond 4 distance + 8 voxels, or after kMaxRaySamples.
RayRoot rayRoot(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double distance,
                double iso) noexcept {
  RayRoot root;
  const double s_max = 4 * distance + 8;
  double inside = 0; // largest s known to lie inside
  double outside = -1;
  double s_last = 0;
  double f_last = -distance;
  double s = distance;
  while (root.samples < kMaxRaySamples) {
    const double f = sampler.phiAtGrid(q + s * n) - iso;
    ++root.samples;
    // s itself, not a corrected one: what follows need not wait for this sample, which only has to
    // agree.
    if (std::abs(f) < kRootTolerance) return {true, s, root.samples};
    // The reciprocal of the slope: the one division of this loop.
    const double per_slope = (s - s_last) / (f - f_last);
    double next = s - f * per_slope;
    const double variation = std::max(std::abs(per_slope - 1), kLeastVariation);
    if (root.samples > 1 && std::abs(f) * variation < kStepTolerance && next > inside)
      return {true, next, root.samples};
    if (f < 0) {
      inside = s;
      // Not less than the distance that is known to be free, nor a leap over a thin gap.
      if (outside < 0) next = s + std::min(std::max(next - s, -f), std::max(1.0, -f));
    } else {
      outside = s;
    }
    if (outside >= 0 && !(next > inside && next < outside)) next = 0.5 * (inside + outside);
    s_last = s;
    f_last = f;
    s = next;
    if (!(s <= s_max)) return root;
    if (s == s_last) return {s > 0, s, root.samples}; // the bracket has no number left inside
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
  contact.deep = sample.region == FieldRegion::deep;
  contact.normal = directionAt(sample, memory);
  double depth = -contact.clearance;
  if (!contact.normal.isZero()) {
    const RayRoot root = rayRoot(sampler_, q, contact.normal, depth, iso_);
    contact.samples += root.samples;
    // A distance's own slope is 1; where the blended gradient is shorter, at a crease, dividing by
    // it would throw the VCP far beyond the part.
    if (root.found) depth = root.s;
  }
  contact.depth = depth * voxel_;
  contact.candidate = contact.tip + contact.depth * contact.normal;
  contact.vcp = contact.candidate;
  contact.surface = contact.candidate - iso_ * voxel_ * contact.normal;
  contact.wall[0] = {contact.normal, contact.depth};
  contact.walls = 1;
  if (last) {
    contact.drawn = contact.candidate - *last;
    contact.snap = contact.normal.dot(memory.ray.normal) < 0;
    if (contact.snap) contact.slip_step = contact.drawn.norm();
  }
  last = contact.candidate;
  memory.ray.normal = contact.normal;
}

} // namespace patina
