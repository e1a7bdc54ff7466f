// A device that moves under the force, and one that stands still.
#pragma once

#include "haptics/device/device.h"
#include "haptics/loop_model/zoh_body.h"

namespace patina {

// A point mass with viscous damping, pushed by a given force of the hand.
struct SimulatedDeviceSpec {
  double mass = 0.1;    // [kg]
  double damping = 0.5; // [N s/m]
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 hand_force = Vec3::Zero();
};

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(const SimulatedDeviceSpec& spec)
      : start_(spec.position), hand_force_(spec.hand_force),
        body_({spec.mass, spec.damping, 0, 0}) {
    for (int i = 0; i < 3; ++i) body_.axes[static_cast<std::size_t>(i)].v = spec.velocity[i];
  }
  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    body_.advance(force + hand_force_, dt);
    return {start_ + body_.position()};
  }

 private:
  Vec3 start_;
  Vec3 hand_force_;
  ZohBody body_;
};

class StillDevice final : public Device {
 public:
  explicit StillDevice(const Vec3& tip) : tip_(tip) {}
  DeviceState exchange(const Vec3&, double) noexcept override { return {tip_}; }

 private:
  Vec3 tip_;
};

} // namespace patina
