// How stiff a sampled wall may be where the device has dry friction or its gears have play: then it
// depends on how fast the handle swings (MATH 2.1.8).
#pragma once

#include <functional>

#include "haptics/stability/stability_limit.h"

namespace patina {

struct WornGear {
  double friction = 0; // [N], Coulomb's, at the handle
  double play = 0;     // [m], at the handle, of the place that is read
};

// The stiffness at which a swing neither grows nor dies, by the describing functions of friction
// and play; `speed` [m/s] is its amplitude for a swing of so many [rad/s]. Without friction and
// play stiffnessLimit(loop). 0 where it grows at any stiffness.
double swingLimit(const SampledLoop& loop, const WornGear& gear,
                  const std::function<double(double)>& speed);

} // namespace patina
