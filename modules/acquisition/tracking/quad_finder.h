// Dark quadrilaterals on brighter ground: candidates for markers and squares of a board.
#pragma once

#include "acquisition/values/camera.h"

namespace patina {

using Quad = std::array<Vec2, 4>; // clockwise in the picture, to about half a pixel

struct QuadOptions {
  double threshold_fraction = 0.5; // threshold between the local minimum (0) and maximum (1)
  // smallest max - min of a neighbourhood in which dark pixels are sought [grey levels]
  int contrast = 20;
  double shortest = 8; // shortest side [px]
};

std::vector<Quad> findQuads(const GreyFrame& image, const QuadOptions& search = {});

} // namespace patina
