// The simulated device of the window: a mass that a hand pulls to where the mouse points.
#pragma once

#include <memory>

#include "haptics/devices/device.h"
#include "scene/device_model.h"

namespace patina {

// A device in a hand that is a spring and a damper towards the target, and never pulls harder than
// max_force. Unlike the mouse's tip, which is where it is told to be, this one yields: at rest it
// is where the surface's force and the hand's are equal. Stepped exactly for a force held over dt
// (F2), delayed and read through its encoder as the model says.
struct HandSpec {
  DeviceModel device;
  double damping = 8.5;   // [N s/m], of the hand: with a usual device it does not swing by itself
  double stiffness = 200; // [N/m]
  double max_force = 3;   // [N]
};
// Throws std::invalid_argument for a device that validate() would refuse.
std::unique_ptr<MouseDevice> makeHandDevice(const Vec3& start, const HandSpec& spec = {});

} // namespace patina
