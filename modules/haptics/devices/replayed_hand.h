// A recorded tip as a device: it goes its way whatever the force.
#pragma once

#include <memory>
#include <vector>

#include "haptics/devices/device.h"
#include "haptics/servo/feel.h"

namespace patina {

// Begins at the first row's time, goes straight between rows and rests at the last. Throws
// std::invalid_argument unless there are rows, all finite, and t increases.
std::unique_ptr<Device> makeReplayedHand(std::vector<TimedTip> path);

} // namespace patina
