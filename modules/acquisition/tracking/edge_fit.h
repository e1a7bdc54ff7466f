// The corners of a dark quadrilateral to hundredths of a pixel: lines fitted to where its edges are
// steepest (A04). Refinements that look at the corner itself are biased by what lies beside it.
#pragma once

#include <optional>

#include "acquisition/tracking/quad_finder.h"

namespace patina {

struct FittedCorner {
  Vec2 pixel;    // in the picture
  Vec2 straight; // where it would be without the lens; the same if there is none
  // To errors of deviation 1: distances to the two lines that meet, each over its deviation.
  Eigen::Matrix2d whiten;
};

struct FittedQuad {
  std::array<FittedCorner, 4> corner; // as those of the quad
  double roughness = 0;               // of the edges about their lines, rms [px]

  Quad pixels() const {
    return {corner[0].pixel, corner[1].pixel, corner[2].pixel, corner[3].pixel};
  }
};

// `lens` straightens the edges; without it they are taken for straight. The quad is `bits` wide, of
// which the outer ones are black: what is nearer to an edge than half of one belongs to it. Nothing
// where a side is not an edge from dark to bright.
std::optional<FittedQuad> fitEdges(const GreyFrame& image, const Quad& quad, const Camera* lens,
                                   int bits = 8);

// Grey between pixels; nothing outside of the image.
inline std::optional<double> greyAt(const GreyFrame& image, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < image.width - 1 && y < image.height - 1)) return std::nullopt;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const double a = x - u, b = y - v;
  const std::uint8_t* p = image.row(v) + u;
  const std::uint8_t* q = p + image.width;
  return (1 - b) * (p[0] + a * (p[1] - p[0])) + b * (q[0] + a * (q[1] - q[0]));
}

} // namespace patina
