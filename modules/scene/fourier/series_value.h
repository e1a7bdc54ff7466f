// What a series is at a place.
#pragma once

#include "scene/fourier/exact_phase.h"

namespace patina {

struct SeriesValue {
  double value = 0, slope = 0; // slope by the phase
};

// Into cells of a ring at x; the slope by -1 .. 1 over a cell.
using SeriesLook = SeriesValue (*)(const ExactRing& ring, const double* cells, double x) noexcept;

// A line's table for a kernel that looks into it by itself.
struct SeriesTable {
  ExactRing ring;
  const double* cells = nullptr; // absent: no line
  int rows = 0;                  // of four coefficients a cell
  double slope_scale = 0;        // from -1 .. 1 over a cell to what is asked for
};

} // namespace patina
