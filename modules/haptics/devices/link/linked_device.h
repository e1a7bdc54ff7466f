// A device of a thread of its own, so that nothing it does keeps the servo waiting.
#pragma once

#include <memory>

#include "haptics/devices/link/link_loop.h"

namespace patina {

struct LinkedSpec {
  GuardSpec guard{};
  double answer_wait = 0.5e-3; // [s] that the servo waits for the answer to what it has sent
  std::shared_ptr<DeviceClock> clock = systemClock();
  std::shared_ptr<LinkNotes> notes = std::make_shared<LinkNotes>();
};

// Its thread takes each command as it comes, at most once a millisecond finds none, and sends no
// force once the newest is older than guard.oldest_command: a servo that has stopped leaves none.
// exchange() waits for the answer for answer_wait at most; what comes later is that of the next
// tick, with its age. It never fails: while the device is away it says so, and goes on when it is
// back. Destroying it waits a second at most: a link that hangs is left to itself. Throws
// std::invalid_argument as LinkLoop does.
std::unique_ptr<Device> makeLinkedDevice(std::unique_ptr<DeviceLink> link, const LinkedSpec& spec);

} // namespace patina
