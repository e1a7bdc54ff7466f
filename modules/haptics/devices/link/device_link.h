// A device that may keep its caller waiting: on a bus, in another's library, over a network.
#pragma once

#include <string>

#include "haptics/devices/device.h"

namespace patina {

// All of it is called by one thread, which is not the servo's; what it may take is bounded. Nothing
// throws.
class DeviceLink {
 public:
  virtual ~DeviceLink() = default;

  struct Opening {
    bool answers = false;
    std::string cause{}; // one line, what keeps it from answering; empty while it merely takes time
    bool told = false;   // of what would mend that: asking again costs nothing
  };
  // A step towards its answering, again and again until it does; after a failure, too, from
  // wherever that has left it. 50 ms or so a step.
  virtual Opening open() noexcept = 0;

  // Sends the force [N] in the device's own frame and reads the state. What is not ok is a fault,
  // of this turn alone or for good, and its position is not used. Waits kLongestTurn at most. A
  // state is the answer to what was sent in this turn, never to what was sent before.
  virtual DeviceState turn(const Vec3& force) noexcept = 0;

  virtual void close() noexcept {} // no force is left; open() may follow
};

inline constexpr double kLongestTurn = 3e-3; // [s]

} // namespace patina
