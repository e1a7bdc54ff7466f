// Places charts in the unit square of an image. Internal to the atlas.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"

namespace patina {

// The border of a chart on its plane, in any order; its inside is where the border's crossings on
// the way out are odd.
struct ChartOutline {
  std::vector<std::array<Vec2, 2>> edges;
};

struct Packing {
  double scale = 0; // texels per unit of the outlines; 0 = they do not fit, however small
  std::vector<Eigen::Affine2d> texel_from_plane; // a turn, `scale`, and a shift; no reflection
};

// All charts at one scale, the largest found by bisection, `gap` texels apart and gap / 2 from the
// image's sides. By their shapes, not their boxes: charts fill each other's bays and holes. The
// order is the longest first. Deterministic.
Packing packed(const std::vector<ChartOutline>& charts, int image_size, int gap);

// No more charts than this should be tried: tiny ones would leave the image to their gaps.
std::size_t mostCharts(int image_size, int gap);

} // namespace patina
