// A SpaceMouse at the wire, as a test or `--device sim:spacemouse` needs it.
#pragma once

#include "haptics/devices/spacemouse/spacemouse.h"

namespace patina {

struct EmulatedCap {
  std::function<CapState(double t)> hand{}; // what it does with the cap at time t [s]
  bool two_reports = false; // the older form, each every 8 ms; the newer comes every 16 ms
  bool attached = true;
};
// One that is plugged in; gone for good where it was not attached once. Throws DeviceError where it
// is not attached now.
std::unique_ptr<UsbTransport> emulateSpaceMouse(std::shared_ptr<const EmulatedCap> cap,
                                                std::shared_ptr<DeviceClock> clock);

} // namespace patina
