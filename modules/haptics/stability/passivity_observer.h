// Passivity observer (Hannaford & Ryu 2002), exact for a held force (MATH 2.3).
#pragma once

#include <algorithm>

#include "core/types.h"

namespace patina {

// A force held for one sample does the work F.(x' - x), so no velocity is needed.
struct PassivityObserver {
  double absorbed = 0; // energy absorbed by the surface, -sum F.dx; negative: generated [J]
  double absorbed_with_damping = 0; // with the device's own damping, sum b dx^2/T [J]
  double lowest_absorbed = 0;       // minimum of each
  double lowest_absorbed_with_damping = 0;

  void add(const Vec3& force, const Vec3& moved, double damping, double seconds) noexcept {
    const double work = force.dot(moved);
    absorbed -= work;
    absorbed_with_damping -= work;
    if (seconds > 0) absorbed_with_damping += damping * moved.squaredNorm() / seconds;
    lowest_absorbed = std::min(lowest_absorbed, absorbed);
    lowest_absorbed_with_damping = std::min(lowest_absorbed_with_damping, absorbed_with_damping);
  }
};

} // namespace patina
