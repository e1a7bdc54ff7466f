// What a series is at a place.
#pragma once

namespace patina {

class ExactRing;

struct SeriesValue {
  double value = 0, slope = 0; // slope by the phase
};

// Into cells of a ring at x; the slope by -1 .. 1 over a cell.
using SeriesLook = SeriesValue (*)(const ExactRing& ring, const double* cells, double x) noexcept;

} // namespace patina
