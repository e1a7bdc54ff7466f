// A force-feedback device as the servo sees it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/types.h"

namespace patina {

enum class DeviceStatus : std::uint8_t {
  ok,
  // The loop holds, without force, until its position means something (again).
  calibrating, // its axes are being homed
  lifted,      // for this turn: off the surface, on the way to another place
  away,        // unplugged, or it has stopped answering; it is being opened anew
  // What follows is final: the loop ends without force.
  silent,  // no answer for longer than kOldestAge
  garbled, // an answer that is none
  gone,    // unplugged, or taken by another program
};
// "answers", "is being calibrated", "has stopped answering" ...: after "the device".
const char* text(DeviceStatus status) noexcept;
// Neither ok nor final.
constexpr bool holds(DeviceStatus status) noexcept {
  return status == DeviceStatus::calibrating || status == DeviceStatus::lifted ||
         status == DeviceStatus::away;
}

// What is older is not felt: the force would be that of another place. [s]
inline constexpr double kOldestAge = 0.02;

struct DeviceState {
  Vec3 position = Vec3::Zero();                                    // [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // of the handle
  std::optional<Vec3> velocity{}; // [m/s], only where the device measures it
  std::uint32_t buttons = 0;      // bit i: button i is down
  DeviceStatus status = DeviceStatus::ok;
  double age = 0; // [s] since the position was measured; grows while answers fail to come
};
// The status, or what the age says against it.
DeviceStatus judge(const DeviceState& state) noexcept;

class Device {
 public:
  virtual ~Device() = default;
  // Servo thread: sends the force [N] and reads the state dt later, both in the world's frame or,
  // below a DeviceMount, in the device's own. No lock, allocation or throw. The force goes to zero
  // where the device is closed, too.
  virtual DeviceState exchange(const Vec3& force, double dt) noexcept = 0;
};

} // namespace patina
