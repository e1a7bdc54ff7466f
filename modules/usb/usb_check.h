// What is wrong with a device on the bus, what would mend it, and how fast it answers.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/percentiles.h"
#include "usb/usb_bus.h"

namespace patina {

struct UsbCheck {
  UsbDevice device;
  std::optional<UsbRefusal> refusal{}; // of the device, or of its interface
  std::string holder{};                // who has it, where that may be seen: "name (process)"
  // From the request for its status, which every device answers, to the answer [us]; empty where it
  // cannot be asked.
  std::vector<double> round_trips{};
};

// Opens it, asks for its interface if it is one of those that we know and no driver has it, and
// asks for its status some times. It is as before after it. Any thread; slow.
UsbCheck checkUsb(const UsbDevice& device, int requests = 200);
UsbCheck checkUsb(const UsbDevice& device, UsbTransport& opened, int requests = 200);

// "ready", "no permission", "in use by spacenavd (813)", "is gone", "does not answer".
std::string stateText(const UsbCheck& check);

// Bins of round trips: up to each of these [us].
inline constexpr std::array<double, 8> kRoundTripBins{
    100, 200, 500, 1000, 2000, 5000, 10000, std::numeric_limits<double>::infinity()};
std::array<std::size_t, 8> histogram(const std::vector<double>& round_trips);

// Probes on a serial line (docs/usb_protocol.md), by what the kernel tells of the USB device
// behind.
struct SerialProbe {
  std::string path; // "/dev/ttyACM0"
  std::string name;
  bool openable = false; // by this user
};
std::vector<SerialProbe> listSerialProbes(const std::string& sys = "/sys/class/tty",
                                          const std::string& dev = "/dev");

} // namespace patina
