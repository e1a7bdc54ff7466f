// The stability map of a compiled scene, on the surface that its field holds.
#pragma once

#include <memory>
#include <optional>

#include "haptics/stability/stability_map.h"
#include "session/build/session.h"

namespace patina {

struct SurfaceStability {
  // The field's own iso-surface at the tip's radius: vertices a voxel apart wherever the mesh has
  // none, so that creases are seen on large triangles too.
  std::shared_ptr<const TriangleMesh> surface;
  StabilityMap map; // one ratio a vertex of `surface`
};

// Seconds on large grids; polls progress, throws Cancelled. nullopt where no vertex can be pressed
// (thin sheets under a tip without a radius).
std::optional<SurfaceStability> surfaceStability(const CompiledScene& compiled, Progress& progress);

// As the layer of the view takes it: what is not touched is no ratio, nor what slips off and does
// not buzz.
std::vector<float> shownRatios(const StabilityMap& map);

} // namespace patina
