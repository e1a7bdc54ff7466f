// Lists the devices on the USB bus, detects haptic devices and opens them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "usb/usb_library.h"
#include "usb/usb_transport.h"

namespace patina {

struct UsbDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;          // reported by the device, or "vendor:product" if it may not be opened
  std::string haptic;        // "Force Dimension", "Novint Falcon" ...; empty for other devices
  bool openable = false;     // true if this user may open it
  std::string advice;        // remedy if not: permissions, a driver that uses it
  int bus = 0, address = 0;  // numbers in /dev/bus/usb
  double megabits = 0;       // link speed [Mbit/s]: 12 is full speed; 0 if unknown
  std::string serial{};      // empty if the device has none
  std::uint16_t release = 0; // device release, mostly its firmware: 0x0123 is 1.23
  std::optional<UsbAccessError> refusal{}; // reason why it cannot be opened
};

// Lists every device on the bus; the list may be empty. Throws DeviceError if the bus cannot be
// read, as in a container without /dev/bus/usb or without libusb. Any thread; slow.
std::vector<UsbDevice> listUsbDevices();

// Opens the first accessible device with this `haptic` name, without claiming an interface. Throws
// DeviceError with the remedy if there is none. Any thread; slow.
std::unique_ptr<UsbTransport> openUsb(std::string_view haptic);
std::unique_ptr<UsbTransport> openUsb(const UsbDevice& device); // opens a listed device

// No such device is attached. `notified_by_hotplug`: the opener is notified of arrivals, so that a
// retry without an arrival costs nothing.
struct NotAttached : DeviceError {
  explicit NotAttached(const std::string& message) : DeviceError(message) {}
  bool notified_by_hotplug = false;
};
// Returns an opener to be called repeatedly, as openUsb(haptic). After a failure it searches the
// bus again only on a hot-plug event or after two seconds. One thread at a time.
std::function<std::unique_ptr<UsbTransport>()> usbOpener(std::string_view haptic);
// Calls UsbLibrary::watch; returns an empty pointer without libusb.
std::shared_ptr<void> watchUsb(std::function<void()> changed);

// `haptic` of a probe (docs/usb_protocol.md): its name starts so, for any vendor and product.
inline constexpr std::string_view kProbeName = "Patina probe";

// Maker or model of a haptic device; empty for an unknown vendor and product.
std::string_view hapticName(std::uint16_t vendor, std::uint16_t product);

// First line of a sysfs attribute with unprintable characters replaced; empty if missing.
std::string readSysfsLine(const std::filesystem::path& file);

// One line for the user; for a missing permission it contains the udev rule to add.
std::string usbAdvice(UsbAccessError refusal, std::uint16_t vendor, std::uint16_t product);
std::string vendorProductText(std::uint16_t vendor, std::uint16_t product); // "0403:cb48"

// Udev rules for access to all known devices; identical to data/70-patina.rules.
inline constexpr const char* kUdevFolder = "/etc/udev/rules.d";
std::string udevRules();
// Writes them into `folder` and returns the file. Throws Error if it cannot be written, or holds
// rules of others.
std::filesystem::path installUdevRules(const std::filesystem::path& folder);

} // namespace patina
