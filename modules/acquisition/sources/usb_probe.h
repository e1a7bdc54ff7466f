// A probe on the USB bus: docs/usb_protocol.md.
#pragma once

#include <functional>
#include <memory>

#include "acquisition/sources/probe_packet.h"
#include "acquisition/sources/sources.h"
#include "usb/usb_transport.h"

namespace patina {

// Claims interface 0, requests the description and starts the stream. `name` is for messages. `now`
// [s] is the clock of arrivals; it never decreases. Throws DeviceError.
std::unique_ptr<ProbeSource> makeUsbProbe(std::unique_ptr<UsbTransport> usb, std::string name,
                                          std::function<double()> now);

// Claims interface 0 and requests the description. `name` is for messages. Throws DeviceError.
ProbeDescription describeProbe(UsbTransport& usb, const std::string& name);

} // namespace patina
