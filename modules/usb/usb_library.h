// Interface of the separately loaded libusb part, so that the program also starts without libusb.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "usb/usb_transport.h"

namespace patina {

// Reason why a device could not be opened (libusb_error).
enum class UsbAccessError : std::uint8_t { permission, held_by_driver, gone, other };

// Descriptor data from the enumeration.
struct UsbDescriptor {
  std::uint16_t vendor = 0, product = 0;
  std::string name;          // maker and product; empty if the device may not be opened
  std::string serial{};      // empty if the device may not be opened
  std::uint16_t release = 0; // device release, mostly its firmware: 0x0123 is 1.23
  int bus = 0, address = 0;  // numbers in /dev/bus/usb
  double megabits = 0;       // link speed [Mbit/s]; 0 if unknown
  bool openable = false;     // true if this user may open it
  std::optional<UsbAccessError> refusal{}; // set if the device is not openable
};

struct UsbLibrary {
  // Both set `cause` if the bus itself fails.
  std::vector<UsbDescriptor> (*list)(std::string& cause);
  // Opens the first device that satisfies `wanted`. Returns nullptr if there is none, or if none
  // could be opened; `refusal` is then the last one's.
  std::unique_ptr<UsbTransport> (*open)(const std::function<bool(const UsbDescriptor&)>& wanted,
                                        std::optional<UsbAccessError>& refusal, std::string& cause);
  // Calls `changed` in a separate thread on each hot-plug event until the returned pointer is
  // released. Returns an empty pointer if libusb does not support hot-plug.
  std::shared_ptr<void> (*watch)(std::function<void()> changed);
};

// Loads the library once. Returns nullptr and the remedy in `cause` if that is impossible.
const UsbLibrary* usbLibrary(std::string& cause);

} // namespace patina
