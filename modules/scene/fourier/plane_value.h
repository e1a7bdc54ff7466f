// What a plane of harmonics is at a place.
#pragma once

namespace patina {

// Value and slopes by the phases.
struct PlaneValue {
  double value = 0, slope_x = 0, slope_y = 0;
};

} // namespace patina
