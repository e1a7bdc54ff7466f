// The square of an area that becomes a texture over x and y.
#pragma once

#include <string>
#include <vector>

#include "acquisition/profilometer/measured_heights.h"
#include "pictures/picture.h"

namespace patina {

// Heights for fitPlane(): (height - lowest) / `height` as grey, over a square of side `length`.
struct SquareArea {
  Picture picture;
  double length = 0; // [m]; a texel more than the distance of the outermost points
  double height = 0; // [m], of white above black
};

// The largest square in the middle, without its least-squares plane, on even steps of the smaller
// of the area's two; heights between points along the other axis are linear. `warnings` gets a line
// where points are left out or steps evened. Throws Error: a profile, more than 4096 points a side,
// heights that are all equal.
SquareArea squareOf(const MeasuredHeights& area, std::vector<std::string>& warnings);

} // namespace patina
