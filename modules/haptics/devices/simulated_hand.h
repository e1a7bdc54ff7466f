// A device in a simulated hand that pulls it to where a pointer says.
#pragma once

#include "haptics/devices/device.h"
#include "haptics/devices/tip_target.h"
#include "scene/device_model.h"

namespace patina {

// The hand is a spring and a damper towards the target, and never pulls harder than max_force.
// Unlike the mouse's tip, which is where it is told to be, this one yields: at rest it is where the
// surface's force and the hand's are equal. The axes of its dry friction and encoder are the
// world's.
struct HandSpec {
  DeviceModel device;
  double damping = 8.5;   // [N s/m], of the hand: with a usual device it does not swing by itself
  double stiffness = 200; // [N/m]
  double max_force = 3;   // [N]
};
// Begins at the target. Throws std::invalid_argument for a device that validate() would refuse.
std::unique_ptr<Device> makeSimulatedHand(std::shared_ptr<const TipTarget> target,
                                          const HandSpec& spec = {});

// The mouse's: the tip is the gliding point itself, feels no force, and alone may leap: a body of
// mass glides there.
std::unique_ptr<Device> makeMouse(std::shared_ptr<const TipTarget> target, double max_speed = 1.0);

} // namespace patina
