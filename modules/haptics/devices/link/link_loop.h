// Opens a device, turns with it, notices what goes wrong, opens it anew: one step at a time.
#pragma once

#include <memory>

#include "haptics/devices/link/device_clock.h"
#include "haptics/devices/link/device_link.h"
#include "haptics/devices/link/force_guard.h"
#include "haptics/devices/link/link_notes.h"

namespace patina {

struct LinkCommand {
  Vec3 force = Vec3::Zero(); // [N], device frame
  double at = -1;            // [s], of the clock, when it was asked for; below 0: never
};

inline constexpr double kTryAgain =
    0.25; // [s], after a device could not be opened, unless it is told

inline constexpr double kGiveUp = 0.05; // [s], of nothing but faults

// The force at the wire is that of the guard: zero from the first turn after a fault was seen.
// Faults that last longer than kGiveUp, or that are for good, close the device and open it anew,
// for as long as it takes.
class LinkLoop {
 public:
  // Throws std::invalid_argument without any of the three.
  LinkLoop(std::unique_ptr<DeviceLink> link, const GuardSpec& guard,
           std::shared_ptr<DeviceClock> clock, std::shared_ptr<LinkNotes> notes);
  ~LinkLoop(); // closes

  // One step. The state that the servo may see: the last good one with its age, calibrating, or
  // away.
  const DeviceState& step(const LinkCommand& command) noexcept;
  double measuredAt() const noexcept { return measured_at_; } // [s]: its position is not older

 private:
  void tryToOpen() noexcept;
  void turn(const LinkCommand& command) noexcept;
  void leave() noexcept;

  std::unique_ptr<DeviceLink> link_;
  ForceGuard guard_;
  std::shared_ptr<DeviceClock> clock_;
  std::shared_ptr<LinkNotes> notes_;
  DeviceState shown_;   // to the servo
  DeviceState reading_; // of the last turn, whatever it was
  bool open_ = false;
  double next_try_ = 0, last_turn_ = 0, measured_at_ = 0, good_at_ = 0; // [s]
  double last_command_ = -1;
};

} // namespace patina
