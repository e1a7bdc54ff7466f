// Devices without hardware: a simulated one that a simulated hand moves to a pointer, a mouse, and
// one that replays a recorded tip path.
#pragma once

#include <memory>
#include <vector>

#include "haptics/device/device.h"
#include "haptics/device/tip_target.h"
#include "haptics/servo/feel.h"
#include "scene/device_model.h"

namespace patina {

// Replays a recorded tip path as a device, independent of the force.

// Starts at the first row's time, interpolates linearly and stays at the last row. Throws
// std::invalid_argument unless there are rows, all values are finite and t increases.
std::unique_ptr<Device> makeReplayedHand(std::vector<TimedTip> path);

// The hand is a spring and damper towards the target with a force limit, so that the tip rests
// where both forces are equal. Dry friction and encoder act along the world's axes.
struct HandSpec {
  DeviceModel device;
  double damping = 8.5;   // hand damping; avoids oscillation with a usual device [N s/m]
  double stiffness = 200; // [N/m]
  double max_force = 3;   // [N]
};
// Starts at the target. Throws std::invalid_argument for a device that validate() rejects.
std::unique_ptr<Device> makeSimulatedHand(std::shared_ptr<const TipTarget> target,
                                          const HandSpec& spec = {});

// Mouse: the tip is the speed-limited target itself, without force. Only the mouse may jump.
std::unique_ptr<Device> makeMouse(std::shared_ptr<const TipTarget> target, double max_speed = 1.0);

} // namespace patina
