// The border of a chart on its plane, and where parts of it come too near. Internal to the atlas.
#pragma once

#include <optional>
#include <vector>

#include "geometry/atlas/atlas_charts.h"

namespace patina {

struct BorderEdge {
  std::int32_t from_vertex, to_vertex; // of the surface
  Vec2 from, to;                       // on the plane; the chart lies on the left
  std::int32_t face;                   // its place in the chart's list
};

// Faces that cover each other, or that no chart should hold both.
struct Clash {
  std::int32_t a, b;
};

// Parts of the border within `clearance` on the plane and much further apart in space: the turns of
// a spiral, say. A look-up at one would read what was painted on the other. Across a slit and round
// a corner both are the same place, more or less. Returns the two furthest apart of those found at
// a quarter of the clearance along the border.
std::optional<Clash> nearMiss(const AtlasSurface& surface, const std::vector<BorderEdge>& border,
                              double clearance);

} // namespace patina
