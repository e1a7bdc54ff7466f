// The stability map in the words of render, export and info.
#pragma once

#include "app/cli/output/reports.h"
#include "session/build/surface_stability.h"

namespace patina::cli {

// For commands that were asked for it: Error where there is none.
SurfaceStability requiredStability(const CompiledScene& compiled, Progress& progress);

// Keys: ratio_min, at[3], ratio_median; buzzing, slipping, jumping (fractions of the vertices; see
// StabilityMap); limit, limit_damped [N/m], coupled; device_given: the scene's device and not the
// default one.
Json stabilityJson(const SurfaceStability& stability, const Scene& scene);
TextRows stabilityRows(const SurfaceStability& stability, const Scene& scene);

} // namespace patina::cli
