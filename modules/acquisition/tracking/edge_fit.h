// Corners of a dark quadrilateral to hundredths of a pixel, as intersections of lines fitted to the
// steepest points of its edges (A04). Refinement at the corner itself is biased by its
// surroundings.
#pragma once

#include <optional>

#include "acquisition/tracking/quad_finder.h"

namespace patina {

struct FittedCorner {
  Vec2 pixel;       // position in the picture
  Vec2 undistorted; // undistorted position; the same without a lens
  // Whitens errors to a deviation of 1: distances to the two lines, each over its deviation.
  Eigen::Matrix2d whiten;
};

struct FittedQuad {
  std::array<FittedCorner, 4> corner; // in the order of the quad's corners
  double roughness = 0;               // rms of the edge points about their lines [px]

  Quad pixels() const {
    return {corner[0].pixel, corner[1].pixel, corner[2].pixel, corner[3].pixel};
  }
};

// `lens` undistorts the edges; nullptr: no distortion. The quad is `bits` wide, with black outer
// bits: up to half a bit from an edge belongs to it. Returns nullopt if a side is not an edge from
// dark to bright.
std::optional<FittedQuad> fitEdges(const GreyFrame& image, const Quad& quad, const Camera* lens,
                                   int bits = 8);

// Interpolates grey bilinearly; nullopt outside the image.
inline std::optional<double> greyAt(const GreyFrame& image, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < image.width - 1 && y < image.height - 1)) return std::nullopt;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const double a = x - u, b = y - v;
  const std::uint8_t* p = image.row(v) + u;
  const std::uint8_t* q = p + image.width;
  return (1 - b) * (p[0] + a * (p[1] - p[0])) + b * (q[0] + a * (q[1] - q[0]));
}

} // namespace patina
