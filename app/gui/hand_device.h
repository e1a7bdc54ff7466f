// The simulated hand of the window: a mass that a hand pulls to where the mouse points.
#pragma once

#include <memory>

#include "haptics/device.h"

namespace patina {

// A mass in a hand that is a spring and a damper towards the target, and never pulls harder than
// max_force. Unlike the mouse's tip, which is where it is told to be, this one yields: at rest it
// is where the surface's force and the hand's are equal. Stepped exactly for a force held over dt
// (F2).
struct HandSpec {
  double mass = 0.1;      // [kg]
  double damping = 9;     // [N s/m]: critical, so that it does not swing by itself
  double stiffness = 200; // [N/m]
  double max_force = 3;   // [N]
};
std::unique_ptr<MouseDevice> makeHandDevice(const Vec3& start, const HandSpec& spec = {});

} // namespace patina
