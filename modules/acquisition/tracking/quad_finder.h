// Dark quadrilaterals on brighter ground: what may be a marker or a square of a board.
#pragma once

#include "acquisition/camera.h"

namespace patina {

// Clockwise as one sees it, to about half a pixel.
using Quad = std::array<Vec2, 4>;

struct QuadSearch {
  double split = 0.5; // of the way from the darkest to the brightest near by: what is below is dark
  int contrast = 20;  // grey levels; where there is less, nothing is dark
  double shortest = 8; // side [px]
};

std::vector<Quad> findQuads(const GreyFrame& image, const QuadSearch& search = {});

} // namespace patina
