// Emulated SpaceMouse at the USB level, for tests and `--device sim:spacemouse`.
#pragma once

#include "haptics/spacemouse/spacemouse.h"

namespace patina {

struct EmulatedCap {
  std::function<CapState(double t)> hand{}; // state of the cap at time t [s]
  bool two_reports = false; // older format with two reports, each every 8 ms; else one every 16 ms
  bool attached = true;
};
// Opens the attached device; a transport that was unplugged once stays dead. Throws DeviceError
// while the device is not attached.
std::unique_ptr<UsbTransport> emulateSpaceMouse(std::shared_ptr<const EmulatedCap> cap,
                                                std::shared_ptr<DeviceClock> clock);

} // namespace patina
