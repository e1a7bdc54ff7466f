// How a felt force along a way differs from the true one.
#pragma once

#include <vector>

#include "core/types.h"

namespace patina {

struct FeltPoint {
  double along = 0;                               // [m], ascending
  Vec3 outward = Vec3::UnitZ();                   // of the surface without texture, unit
  Vec3 felt = Vec3::Zero(), truth = Vec3::Zero(); // [N]
};

struct FeltError {
  double whole = 0;          // rms of the difference over the rms of the truth
  double variation = 0;      // the same of the part along `outward`, less its mean in each window
  double lag = 0;            // of all windows the largest, along the way [m]
  double true_variation = 0; // rms [N]
  std::size_t windows = 0;
};

// In windows of `window` [m], each shifted along the way by up to `most_lag` [m] as fits it best;
// what is left of the way is no window. Throws Error where there is not one.
FeltError feltError(const std::vector<FeltPoint>& points, double window = 10e-3,
                    double most_lag = 0.5e-3);

} // namespace patina
