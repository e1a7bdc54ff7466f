// Finds faces that overlap in an image. Internal to the atlas.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "geometry/atlas/atlas_charts.h"
#include "geometry/atlas/texture_layout.h"

namespace patina {

// Detects whether a chart overlaps itself on its plane, and cuts it there. Internal to the atlas.

// Axes of a chart's plane, with e1 x e2 = normal.
struct ChartPlane {
  Vec3 e1, e2;
  explicit ChartPlane(const Vec3& normal);
  Vec2 operator()(const Vec3& p) const { return {e1.dot(p), e2.dot(p)}; }
};

// Limits in the surface's unit.
struct ChartLimits {
  double longest = std::numeric_limits<double>::infinity(); // extent in the plane
  double clearance = 0; // on the plane, of parts that are far apart in space
};

// Returns the chart, or connected pieces of it that do not overlap themselves. All faces look along
// the chart's normal, so a piece is embedded exactly if the faces at no vertex wind round it twice
// and its boundary does not cross or overlap itself; faces need not be compared in pairs. Pieces
// that exceed the limits are also cut, if their faces allow it.
std::vector<Chart> embeddedPieces(const AtlasSurface& surface, Chart chart,
                                  const ChartLimits& limits);

// Texture coordinates closer than this are equal: a quarter of a texel of the largest image, and
// the rounding of files with five decimals or single precision.
inline constexpr double kUvResolution = 1.0 / 65536;

struct UvOverlap {
  std::int32_t a = kNone, b = kNone; // two faces, a < b
};

// Returns two faces that no shift by kUvResolution would separate, or nothing. Faces at a common
// edge or corner do not overlap, nor do narrow faces that rounding folds; faces narrower than
// kUvResolution are skipped. Applies the separating axis theorem to pairs from a quadtree, without
// sampling. O(n log n) for n faces; parallel; deterministic.
std::optional<UvOverlap> findUvOverlap(const CornerUvs& uvs);

} // namespace patina
