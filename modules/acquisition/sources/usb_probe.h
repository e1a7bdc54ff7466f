// A probe on the USB bus: docs/usb_protocol.md.
#pragma once

#include <functional>
#include <memory>

#include "acquisition/sources/probe_packet.h"
#include "acquisition/sources/sources.h"
#include "usb/usb_transport.h"

namespace patina {

// Claims interface 0, asks for the description, and lets the stream begin. `name` stands in
// messages. `now` [s] is when packets arrive; it never runs back. Throws DeviceError.
std::unique_ptr<ProbeSource> makeUsbProbe(std::unique_ptr<UsbTransport> usb, std::string name,
                                          std::function<double()> now);

// Claims interface 0 and asks what it is. `name` stands in messages. Throws DeviceError.
ProbeDescription describeProbe(UsbTransport& usb, const std::string& name);

} // namespace patina
