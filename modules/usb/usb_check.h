// Checks whether a USB device can be used, and measures its response time.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/percentiles.h"
#include "usb/usb_bus.h"

namespace patina {

struct UsbCheck {
  UsbDevice device;
  std::optional<UsbAccessError> refusal{}; // access error of the device or its interface
  std::string holder{}; // process that has the device open, if visible: "name (process)"
  // Times from GET_STATUS to the reply [us]; empty if the device cannot be opened.
  std::vector<double> round_trips{};
};

// Opens the device, measures `requests` status requests and, for a known haptic device, tries to
// claim its interface. Leaves the device unchanged. Any thread; slow.
UsbCheck checkUsb(const UsbDevice& device, int requests = 200);
UsbCheck checkUsb(const UsbDevice& device, UsbTransport& opened, int requests = 200);

// "ready", "no permission", "in use by spacenavd (813)", "is gone", "does not answer".
std::string stateText(const UsbCheck& check);

// Upper bounds of the histogram bins of round trips [us].
inline constexpr std::array<double, 8> kRoundTripBins{
    100, 200, 500, 1000, 2000, 5000, 10000, std::numeric_limits<double>::infinity()};
std::array<std::size_t, 8> histogram(const std::vector<double>& round_trips);

// Probe on a serial line (docs/usb_protocol.md), detected by the sysfs entry of its USB device.
struct SerialProbe {
  std::string path; // "/dev/ttyACM0"
  std::string name;
  bool openable = false; // true if this user may open it
};
std::vector<SerialProbe> listSerialProbes(const std::string& sys = "/sys/class/tty",
                                          const std::string& dev = "/dev");

} // namespace patina
