// Safety guard between the requested forces and every real device.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "haptics/device/device.h"

namespace patina {

// Reason why no force is sent; the first that applies, in this order.
enum class ForceInhibit : std::uint8_t {
  none,
  device,           // device status
  servo,            // no command for longer than GuardSpec::max_command_age
  ui_timeout,       // no UI heartbeat for longer than GuardSpec::max_heartbeat_age
  command,          // requested force is not finite
  deadman_released, // the dead-man's button is released
};
// Returns text for "no force: ...", such as "the servo is late".
const char* text(ForceInhibit inhibit) noexcept;

// Thermal model of the windings: heated by the square of the force, cooled with one time constant.
// Heat is 1 at a permanent force `continuous`.
struct MotorHeat {
  double continuous = std::numeric_limits<double>::infinity(); // [N]
  double time_constant = 60;                                   // [s]
};

struct GuardSpec {
  double max_force = std::numeric_limits<double>::infinity(); // limit of the magnitude [N]
  std::optional<Box3> workspace{}; // [m]; no force pushes further outwards
  MotorHeat motors{};
  Vec3 weight = Vec3::Zero();     // handle's weight, compensated as part of the force [N]
  double max_command_age = 3e-3;  // [s]
  double max_heartbeat_age = 0.5; // [s]; the window sends 30 heartbeats per second
  double ramp = 0.25;             // [s], from zero to full force
};

inline constexpr double kWorkspaceEdge = 2e-3; // width over which outward force fades to zero [m]

// An inhibit removes the force at once; afterwards it returns linearly over `ramp`. Motors near
// their thermal limit get less force, down to the permanent one, so that heat never exceeds 1.
class ForceGuard {
 public:
  struct ForceRequest {
    Vec3 force = Vec3::Zero();     // [N], device frame
    double command_age = 0;        // [s]
    double heartbeat_age = 0;      // [s]
    bool requires_deadman = false; // force only while a button of the device is held
  };
  // Throws std::invalid_argument unless limits, ramp and times are positive, and if motors have a
  // thermal limit but the force has none.
  explicit ForceGuard(const GuardSpec& spec);
  // Returns the force for the next dt [s], given the last reading. Finite for any input.
  Vec3 limit(const ForceRequest& asked, const DeviceState& reading, double dt) noexcept;
  ForceInhibit inhibit() const noexcept { return inhibit_; }
  double gain() const noexcept { return gain_; } // factor of the force, 0 to 1
  double heat() const noexcept { return heat_; } // heat of the motors, 0 to 1

 private:
  ForceInhibit inhibitFor(const ForceRequest& asked, const DeviceState& reading) const noexcept;
  double maxNow() const noexcept;

  GuardSpec spec_;
  ForceInhibit inhibit_ = ForceInhibit::device;
  double gain_ = 0;
  double heat_ = 0;
};

} // namespace patina
