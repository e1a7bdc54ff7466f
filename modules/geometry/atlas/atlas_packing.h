// Places charts in the unit square of an image. Internal to the atlas.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"

namespace patina {

// Boundary edges of a chart on its plane, in any order. A point is inside if a ray from it crosses
// the boundary an odd number of times.
struct ChartOutline {
  std::vector<std::array<Vec2, 2>> edges;
};

struct Packing {
  double scale = 0; // texels per unit of the outlines; 0 = they do not fit at any scale
  std::vector<Eigen::Affine2d> texel_from_plane; // rotation, `scale` and translation; no reflection
};

// Packs all charts at one scale, the largest that bisection finds, `gap` texels apart and gap / 2
// from the image's sides. Shapes are compared, not bounding boxes, so that charts fill each other's
// concavities and holes. The longest chart is placed first. Deterministic.
Packing packed(const std::vector<ChartOutline>& charts, int image_size, int gap);

// Returns the largest useful number of charts: with more, gaps would fill the image.
std::size_t maxCharts(int image_size, int gap);

} // namespace patina
