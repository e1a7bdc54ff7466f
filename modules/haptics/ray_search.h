// The frictionless VCP as a root along a ray, in grid coordinates (K06). Nothing here knows metres,
// so that nothing depends on the size of the model.
#pragma once

#include <algorithm>
#include <cmath>

#include "field/field_sampler.h"

namespace patina {

// Voxels; values near the surface are good to some 2e-7 (float).
inline constexpr double kRootTolerance = 1e-6;
// A step from the second sample on leaves about |f| times the variation of the slope along the ray.
// The slope of a distance along its own direction is 1, except across creases, where the secant's
// difference from 1 tells; a trilinear value adds some h / 2R.
inline constexpr double kStepTolerance = 5e-7;
inline constexpr double kLeastVariation = 0.01;
inline constexpr int kMaxRaySamples = 64;

struct RayRoot {
  bool found = false;
  double s = 0; // voxels along the direction
  int samples = 0;
};

// First s > 0 with phi(q + s n) = iso, for phi(q) = iso - distance < iso and |n| = 1. The distance
// of a signed distance field is a lower bound of s, so the search starts there; it goes on in steps
// of at most max(1 voxel, |phi - iso|) until the surface is bracketed, then by safeguarded secants.
// Gives up beyond 4 distance + 8 voxels, or after kMaxRaySamples.
inline RayRoot rayRoot(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double distance,
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
    if (std::abs(f) < kRootTolerance) {
      root.s = s;
      root.found = true;
      return root;
    }
    // The reciprocal of the slope: the one division of this loop.
    const double per_slope = (s - s_last) / (f - f_last);
    double next = per_slope > 0 && per_slope < 20 ? s - f * per_slope : s - f;
    const double variation = std::max(std::abs(per_slope - 1), kLeastVariation);
    if (root.samples > 1 && std::abs(f) * variation < kStepTolerance && next > inside) {
      root.s = next;
      root.found = true;
      return root;
    }
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
    if (s == s_last) { // the bracket has no number left inside
      root.s = s;
      root.found = s > 0;
      return root;
    }
  }
  return root;
}

} // namespace patina
