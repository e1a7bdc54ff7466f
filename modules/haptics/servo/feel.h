// A tip path felt through the servo's own code, in simulated time.
#pragma once

#include <vector>

#include "core/progress.h"
#include "haptics/servo/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct TimedTip {
  double t = 0;
  Vec3 tip = Vec3::Zero();
};

// One sample a row; dt is the difference of successive t. Throws Error if t does not increase.
std::vector<ToolSample> feel(const HapticSnapshot& snapshot, const std::vector<TimedTip>& path,
                             Progress& progress);

} // namespace patina
