// A tip path felt through the servo's own code, in simulated time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "haptics/devices/device.h"
#include "haptics/servo/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct TimedTip {
  double t = 0;
  Vec3 tip = Vec3::Zero();
};

// A pause longer than kOldestAge and than so many of the ticks before it: the tip was lifted, and
// is felt anew where it comes down, whatever lies between.
inline constexpr double kPause = 4;

// One sample a tip, in memory that does not grow with the path: `next` gives a tip until it has
// none, `take` gets its sample. dt is the difference of successive t, of the first tip that to the
// second; after a pause as before it. Returns how many pauses there were. Throws Error if t does
// not increase, Cancelled, and whatever the two throw.
std::size_t feel(const HapticSnapshot& snapshot,
                 const std::function<std::optional<TimedTip>()>& next,
                 const std::function<void(const ToolSample&)>& take, const Progress& progress);
// The same of a path that is whole.
std::vector<ToolSample> feel(const HapticSnapshot& snapshot, const std::vector<TimedTip>& path,
                             Progress& progress);

} // namespace patina
