// Fits a texture over x and y to a height map (A21).
#pragma once

#include <optional>

#include "core/progress.h"
#include "pictures/picture.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

struct PlaneFitOptions {
  double length = 0;  // side of the picture, one period; if blended, one texel more [m]
  double height = 0;  // height of white above black [m]
  int harmonics = 32; // largest number along each axis
  // Width of the blended zone at the ends, relative to the side, that makes the heights periodic
  // along x and then along y (seamless()). 0: they are periodic.
  double blend = 0;
  // Number of products of a line along x and one along y whose sum replaces the plane (low-rank
  // approximation); 0: the fewest with a relative error of at most `max_relative_error`. Absent:
  // the plane itself.
  std::optional<int> rank;
  double max_relative_error = 0.01;
};

struct FittedPlane {
  FourierTexture texture;
  std::size_t samples = 0;   // samples per period, along each axis
  int rank = 0;              // number of products; 0: the plane itself
  double rms = 0;            // blended heights about their mean [m]
  double residual = 0;       // rms of the blended heights minus the texture [m]
  double relative_error = 0; // relative rms error of the low-rank approximation
};

// Uses the picture's first channel, with row 0 at y = 0; it must be square, as a texture has the
// same period along both axes. Throws Error: another shape, fewer than 4 texels, all heights equal;
// Cancelled.
FittedPlane fitPlane(const Picture& picture, const PlaneFitOptions& options, Progress& progress);

} // namespace patina
