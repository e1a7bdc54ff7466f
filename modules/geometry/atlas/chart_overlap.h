// Whether a chart covers itself on its plane, and cuts where it does. Internal to the atlas.
#pragma once

#include <limits>
#include <vector>

#include "geometry/atlas/atlas_charts.h"

namespace patina {

// Axes of a chart's plane; e1 x e2 is its normal.
struct ChartPlane {
  Vec3 e1, e2;
  explicit ChartPlane(const Vec3& normal);
  Vec2 operator()(const Vec3& p) const { return {e1.dot(p), e2.dot(p)}; }
};

// In the surface's unit.
struct ChartLimits {
  double longest = std::numeric_limits<double>::infinity(); // along an axis of the plane
  double clearance = 0; // parts that are far apart in space are not nearer than this on the plane
};

// The chart itself, or connected pieces of it of which none covers itself. All faces look along the
// chart's normal, so a piece is embedded exactly if no vertex is wound round twice and its border
// neither crosses nor overlaps itself: the border is short, and no pair of faces need be compared.
// Pieces beyond the limits are cut too, as far as their faces allow.
std::vector<Chart> embeddedPieces(const AtlasSurface& surface, Chart chart,
                                  const ChartLimits& limits);

} // namespace patina
