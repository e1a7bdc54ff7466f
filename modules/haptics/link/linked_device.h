// Device with its own thread, so that the device never blocks the servo.
#pragma once

#include <memory>

#include "haptics/link/link_loop.h"

namespace patina {

struct LinkedSpec {
  GuardSpec guard{};
  double reply_timeout = 0.5e-3; // time that the servo waits for a reply [s]
  std::shared_ptr<DeviceClock> clock = systemClock();
  std::shared_ptr<LinkStatistics> notes = std::make_shared<LinkStatistics>();
};

// The device thread takes each command as it arrives, checks at least once a millisecond, and sends
// no force if the newest is older than guard.max_command_age: a stopped servo leaves no force
// behind. exchange() waits for the reply for at most reply_timeout; a later reply is returned in
// the next tick, with its age. exchange() never fails: the state is `reconnecting` until the device
// is back. The destructor waits at most a second and then abandons a hanging link. Throws
// std::invalid_argument as LinkLoop does.
std::unique_ptr<Device> makeLinkedDevice(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec);

} // namespace patina
