// The stability map in the words of render, export and info.
#pragma once

#include "app/cli/output/reports.h"
#include "session/build/surface_stability.h"

namespace patina::cli {

// For commands that were asked for it: Error where there is none.
SurfaceStability requiredStability(const CompiledScene& compiled, Progress& progress);

// Fractions are of the vertices; see StabilityMap.
const Keys& stabilityKeys();
Report stabilityReport(const SurfaceStability& stability, const Scene& scene);

} // namespace patina::cli
