// Value of a series at a point.
#pragma once

#include "scene/fourier/reduced_phase.h"

namespace patina {

struct SeriesValue {
  double value = 0, slope = 0; // slope by the phase
};

// Evaluates periodic cells at x; the slope is by -1 .. 1 over a cell.
using SeriesKernel = SeriesValue (*)(const PeriodicCells& ring, const double* cells,
                                     double x) noexcept;

// Table of a texture over x only (TextureKind::line), as plain data for kernels.
struct SeriesTable {
  PeriodicCells ring;
  const double* cells = nullptr; // null: the texture is of another kind
  int rows = 0;                  // rows of four coefficients per cell
  double slope_scale = 0;        // converts the slope by -1 .. 1 over a cell to the caller's unit
};

} // namespace patina
