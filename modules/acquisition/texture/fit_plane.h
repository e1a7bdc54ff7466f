// A picture of heights becomes a texture over x and y (A21).
#pragma once

#include <optional>

#include "core/progress.h"
#include "pictures/picture.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

struct PlaneFitOptions {
  double length = 0;  // of the picture's side, a period; blended, a texel more than that [m]
  double height = 0;  // of white above black [m]
  int harmonics = 32; // along each axis, at most
  // Of the side, at its ends: heights there are bent so that the picture repeats itself, along x
  // and then along y (seamless()). 0: they do.
  double blend = 0;
  // The plane as a sum of so many products of a line along x and one along y; 0: of the fewest that
  // lack no more than `lacks` of the plane's rms. Absent: the plane itself.
  std::optional<int> rank;
  double lacks = 0.01;
};

struct FittedPlane {
  FourierTexture texture;
  int rank = 0;        // of products; 0: the plane itself
  double rms = 0;      // of the heights from their mean [m]
  double residual = 0; // rms of what the texture lacks of the bent heights [m]
  double lacking = 0;  // of the plane's rms, what the products lack of it
};

// picture: its first channel, row 0 at y = 0; square, for a texture has one period along both axes.
// Throws Error: another shape, fewer than 4 texels, no height anywhere; Cancelled.
FittedPlane fitPlane(const Picture& picture, const PlaneFitOptions& options, Progress& progress);

} // namespace patina
