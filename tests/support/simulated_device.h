// A device that yields, and one that stands still.
#pragma once

#include "haptics/devices/device.h"
#include "haptics/devices/exact_step.h"

namespace patina {

// A point mass with viscous damping in a hand that pushes with a given force.
struct SimulatedDeviceSpec {
  double mass = 0.1;    // [kg]
  double damping = 0.5; // [N s/m]
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 hand_force = Vec3::Zero();
};

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(const SimulatedDeviceSpec& spec) : spec_(spec) {}
  Vec3 exchange(const Vec3& force, double dt) noexcept override {
    const HeldStep step = heldStep({spec_.mass, spec_.damping, 0, 0}, dt);
    const Vec3 total = force + spec_.hand_force;
    spec_.position += step.xv * spec_.velocity + step.xf * total;
    spec_.velocity = step.vv * spec_.velocity + step.vf * total;
    return spec_.position;
  }

 private:
  SimulatedDeviceSpec spec_;
};

class StillDevice final : public Device {
 public:
  explicit StillDevice(const Vec3& tip) : tip_(tip) {}
  Vec3 exchange(const Vec3&, double) noexcept override { return tip_; }

 private:
  Vec3 tip_;
};

} // namespace patina
