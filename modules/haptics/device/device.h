// A force-feedback device, as the servo uses it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/types.h"

namespace patina {

enum class DeviceStatus : std::uint8_t {
  ok,
  // The loop continues without force until the position is valid (again).
  calibrating,   // the axes are being homed
  repositioning, // moves to another position without contact
  reconnecting,  // disconnected or not responding; being reopened
  // Final states: the loop ends without force.
  timed_out,      // no reply for longer than kMaxStateAge
  protocol_error, // invalid reply
  gone,           // unplugged, or taken over by another program
};
// Returns text for "the device ...", such as "is being calibrated".
const char* text(DeviceStatus status) noexcept;
// True for states that are neither ok nor final.
constexpr bool holds(DeviceStatus status) noexcept {
  return status == DeviceStatus::calibrating || status == DeviceStatus::repositioning ||
         status == DeviceStatus::reconnecting;
}

// Maximum age of a state; an older one would give the force of another position. [s]
inline constexpr double kMaxStateAge = 0.02;

struct DeviceState {
  Vec3 position = Vec3::Zero();                                    // [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // orientation of the handle
  std::optional<Vec3> velocity{}; // [m/s], only if the device measures it
  std::uint32_t buttons = 0;      // bit i: button i is down
  DeviceStatus status = DeviceStatus::ok;
  double age = 0; // [s] since the measurement; grows while replies are missing
};
// Returns the status, or timed_out if it is ok but the state is too old.
DeviceStatus effectiveStatus(const DeviceState& state) noexcept;

class Device {
 public:
  virtual ~Device() = default;
  // Servo thread: sends the force [N] and reads the state dt later, both in the world frame or,
  // below mountDevice(), in the device frame. Neither locks nor allocates nor throws. Closing the
  // device also sets the force to zero.
  virtual DeviceState exchange(const Vec3& force, double dt) noexcept = 0;
};

} // namespace patina
