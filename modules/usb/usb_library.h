// What is done with libusb, in a library of its own: a program starts, and says so, without it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "usb/usb_transport.h"

namespace patina {

// Why a device could not be opened, as libusb sees it.
enum class UsbRefusal : std::uint8_t { permission, held_by_driver, gone, other };

// A device as the bus tells it, before anything of ours is known of it.
struct UsbFound {
  std::uint16_t vendor = 0, product = 0;
  std::string name;                    // maker and product; empty if it may not be asked
  std::string serial{};                // likewise
  std::uint16_t release = 0;           // of the device, mostly its firmware: 0x0123 is 1.23
  int bus = 0, address = 0;            // as in /dev/bus/usb
  double megabits = 0;                 // of its cable; 0 if unknown
  bool openable = false;               // by this user
  std::optional<UsbRefusal> refusal{}; // where it is not openable
};

struct UsbLibrary {
  // Both say in `cause` what went wrong with the bus itself.
  std::vector<UsbFound> (*list)(std::string& cause);
  // The first for which `wanted`. nullptr: there is none, or `refusal` of the last that there is.
  std::unique_ptr<UsbTransport> (*open)(const std::function<bool(const UsbFound&)>& wanted,
                                        std::optional<UsbRefusal>& refusal, std::string& cause);
  // Calls `changed` in a thread of its own when a device has come or gone, until what it returns
  // is let go. Empty where libusb does not tell.
  std::shared_ptr<void> (*watch)(std::function<void()> changed);
};

// Loaded with the first call. nullptr where it cannot be, or where this build has none; `cause`
// says what to do.
const UsbLibrary* usbLibrary(std::string& cause);

} // namespace patina
