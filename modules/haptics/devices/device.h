// The hand's side of the loop.
#pragma once

#include <memory>

#include "core/types.h"

namespace patina {

class Device {
 public:
  virtual ~Device() = default;
  // Servo thread: sends the force [N] and reads the tip [m, world] dt later. No lock, allocation or
  // throw.
  virtual Vec3 exchange(const Vec3& force, double dt) noexcept = 0;
};

// The mouse: the window sets a target from its thread, the servo glides to it at no more than
// max_speed, so that a jump of the pointer is not a jump of the tip. It feels no force.
class MouseDevice : public Device {
 public:
  virtual void setTarget(const Vec3& world) noexcept = 0; // UI thread, wait-free
};
std::unique_ptr<MouseDevice> makeMouseDevice(const Vec3& start, double max_speed = 1.0);

} // namespace patina
