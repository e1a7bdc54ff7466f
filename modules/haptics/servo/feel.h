// Runs a tip path through the servo's force law in simulated time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "haptics/device/device.h"
#include "haptics/law/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct TimedTip {
  double t = 0;
  Vec3 tip = Vec3::Zero();
};

// A pause longer than kMaxStateAge and than this many preceding ticks: the tip was lifted, and
// contact starts afresh where it comes down.
inline constexpr double kPause = 4;

// Passes one sample per tip to `take`, in constant memory, until `next` is empty. dt is the
// difference of successive t; the first tip and a tip after a pause use the neighbouring dt.
// Returns the number of pauses. Throws Error if t does not increase, Cancelled, and the two
// functions' exceptions.
std::size_t feel(const HapticSnapshot& snapshot,
                 const std::function<std::optional<TimedTip>()>& next,
                 const std::function<void(const ToolSample&)>& take, const Progress& progress);
// The same for a complete path.
std::vector<ToolSample> feel(const HapticSnapshot& snapshot, const std::vector<TimedTip>& path,
                             Progress& progress);

} // namespace patina
