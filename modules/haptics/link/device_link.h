// A device whose calls may block: on a bus, in another library, over a network.
#pragma once

#include <string>

#include "haptics/device/device.h"

namespace patina {

// Called by one thread, which is not the servo's. Blocking is bounded, and no function throws.
class DeviceLink {
 public:
  virtual ~DeviceLink() = default;

  struct Opening {
    bool answers = false;
    std::string cause{};              // one line: the failure; empty while opening takes more steps
    bool notified_by_hotplug = false; // arrivals are notified, so a retry costs nothing
  };
  // Performs one step of about 50 ms towards opening. The caller repeats it until the device
  // responds, also after a failure, from any state.
  virtual Opening open() noexcept = 0;

  // Sends the force [N] in the device frame and reads the state; waits at most kMaxExchangeTime. A
  // status other than ok is a fault, of this exchange or final, and its position is not used. The
  // state always answers this exchange's command, never an earlier one.
  virtual DeviceState exchange(const Vec3& force) noexcept = 0;

  virtual void close() noexcept {} // leaves no force behind; open() may follow
};

inline constexpr double kMaxExchangeTime = 3e-3; // [s]

} // namespace patina
