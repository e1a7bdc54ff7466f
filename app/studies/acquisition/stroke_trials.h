// Counts the strokes that a scan of a known body needs, by several ways to choose them.
#pragma once

#include "acquisition/registration/next_stroke.h"
#include "app/studies/framework/study.h"

namespace patina {

enum class StrokeChoice { advised, random, raster };

struct StrokeTrial {
  std::size_t strokes = 0; // strokes until pose and heights meet the goal, or 300
  double error = 0;        // error of the pose at the end: rms displacement of the mesh [m]
  double area = 0;         // share of the area that meets the goal at the end
  double seconds = 0;      // processor time
};

// Goal of the trials: pose to 0.1 mm, heights to 0.2 mm over 95 % of the area, by strokes of 80 mm.
ScanGoal trialGoal();
StrokeOptions trialStrokes();

// Scans a body stroke by stroke. After each the path is registered, and its true error decides. A
// raster goes over the body from above and below, along x, then along y, then both between the
// first lines. Samples are 2 mm apart with independent errors of 0.3 mm, and a hand misses a
// planned stroke by 1 mm.
StrokeTrial strokesUntilKnown(const SurfaceTarget& target, StrokeChoice choice, unsigned seed);

// One row per body and choice.
WorkPrecisionTable strokeTable(const StudyOptions& options, Progress& progress);

} // namespace patina
