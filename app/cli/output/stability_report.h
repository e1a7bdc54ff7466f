// Stability part of the reports of render, export and info.
#pragma once

#include "app/cli/output/reports.h"
#include "session/open/surface_stability.h"

namespace patina::cli {

// Throws Error if there is no stability map.
SurfaceStability requiredStability(const CompiledScene& compiled, Progress& progress);

// Fractions of the vertices; see StabilityMap.
const Keys& stabilityKeys();
Report stabilityReport(const SurfaceStability& stability, const Scene& scene);

} // namespace patina::cli
