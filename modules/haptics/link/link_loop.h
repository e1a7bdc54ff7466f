// Opens a device, exchanges with it, detects faults and reopens it, one step at a time.
#pragma once

#include <memory>

#include "haptics/link/device_clock.h"
#include "haptics/link/device_link.h"
#include "haptics/link/force_guard.h"
#include "haptics/link/link_statistics.h"

namespace patina {

struct LinkCommand {
  Vec3 force = Vec3::Zero(); // [N], device frame
  double at = -1;            // clock time of the command [s]; below 0: none yet
};

// Retry interval after a failed opening without hot-plug notification [s].
inline constexpr double kRetryInterval = 0.25;

inline constexpr double kFaultTimeout =
    0.05; // duration of faults before the device is reopened [s]

// Sends the guard's force, zero from the first exchange after a fault. Final faults, and faults
// longer than kFaultTimeout, close the device, which is then reopened without a time limit.
class LinkLoop {
 public:
  // Throws std::invalid_argument if one of the three is missing.
  LinkLoop(std::unique_ptr<DeviceLink> link, const GuardSpec& guard,
           std::shared_ptr<DeviceClock> clock, std::shared_ptr<LinkStatistics> notes);
  ~LinkLoop(); // closes the device

  // Performs one step; returns the last good state with its age, calibrating or reconnecting.
  const DeviceState& step(const LinkCommand& command) noexcept;
  // Earliest possible time of the position [s].
  double measuredAt() const noexcept { return measured_at_; }

 private:
  void tryToOpen() noexcept;
  void exchange(const LinkCommand& command) noexcept;
  void leave() noexcept;

  std::unique_ptr<DeviceLink> link_;
  ForceGuard guard_;
  std::shared_ptr<DeviceClock> clock_;
  std::shared_ptr<LinkStatistics> notes_;
  DeviceState shown_;   // passed to the servo
  DeviceState reading_; // result of the last exchange
  bool open_ = false;
  double next_try_ = 0, last_exchange_ = 0, measured_at_ = 0, good_at_ = 0; // [s]
  double last_command_ = -1;
};

} // namespace patina
