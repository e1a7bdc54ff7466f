// What a held force gives to the device it moves and takes from it, exactly (MATH 2.3).
#pragma once

#include <algorithm>

#include "core/types.h"

namespace patina {

// A force held from one sample to the next does the work F.(x' - x): no velocity is needed.
struct EnergyLedger {
  double absorbed = 0; // [J], by the surface from the hand: -sum F.dx; below 0 it has given energy
  double credited = 0; // with what the device's damping takes at least, sum b dx^2/T, as well
  double lowest_absorbed = 0; // the least of each
  double lowest_credited = 0;

  void add(const Vec3& force, const Vec3& moved, double damping, double seconds) noexcept {
    const double work = force.dot(moved);
    absorbed -= work;
    credited -= work;
    if (seconds > 0) credited += damping * moved.squaredNorm() / seconds;
    lowest_absorbed = std::min(lowest_absorbed, absorbed);
    lowest_credited = std::min(lowest_credited, credited);
  }
};

} // namespace patina
