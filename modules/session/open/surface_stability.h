// Stability map of a compiled scene on the iso-surface of its field.
#pragma once

#include <memory>
#include <optional>

#include "haptics/stability/stability_map.h"
#include "session/open/session.h"

namespace patina {

struct SurfaceStability {
  // Iso-surface of the field at the tip's radius. Its vertices are a voxel apart, so that creases
  // between large triangles are covered too.
  std::shared_ptr<const TriangleMesh> surface;
  StabilityMap map; // one ratio per vertex of `surface`
};

// Takes seconds on large grids; polls progress, throws Cancelled. nullopt if no vertex can be
// pressed (thin sheets under a tip without a radius).
std::optional<SurfaceStability> surfaceStability(const CompiledScene& compiled, Progress& progress);

// Ratios for the view's layer: vertices that cannot be touched, and unstable ones that do not buzz,
// get special values.
std::vector<float> displayRatios(const StabilityMap& map);

} // namespace patina
