// What hangs on the USB bus, which of it is a haptic device, and how one is opened.
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
  std::string name;      // from the device, or "vendor:product" where it may not be opened
  std::string haptic;    // "Force Dimension", "Novint Falcon" ...; empty if it is none that we know
  bool openable = false; // by this user
  std::string advice;    // what to do if not: permissions, a driver that holds it
  int bus = 0, address = 0;            // as in /dev/bus/usb
  double megabits = 0;                 // of its cable: 12 is full speed; 0 if unknown
  std::string serial{};                // empty if it says none
  std::uint16_t release = 0;           // of the device, mostly its firmware: 0x0123 is 1.23
  std::optional<UsbRefusal> refusal{}; // what forbids it, where advice says what to do
};

// Every device on the bus; an empty list if there is a bus with nothing on it. Throws DeviceError
// if the bus cannot be read at all, as in a container without /dev/bus/usb, or without libusb. Any
// thread; slow.
std::vector<UsbDevice> listUsbDevices();

// The first device whose `haptic` is this that may be opened; nothing of it is claimed yet. Throws
// DeviceError with what to do where there is none. Any thread; slow.
std::unique_ptr<UsbTransport> openUsb(std::string_view haptic);
std::unique_ptr<UsbTransport> openUsb(const UsbDevice& device); // this one, where it was listed

// None is plugged in. `told`: what threw it is told of arrivals, so that asking again costs
// nothing.
struct NotAttached : DeviceError {
  explicit NotAttached(const std::string& message) : DeviceError(message) {}
  bool told = false;
};
// openUsb(haptic), again and again: once there was none, it looks at the bus when something has
// been plugged in, and every two seconds in case that nobody tells. One thread's at a time.
std::function<std::unique_ptr<UsbTransport>()> usbOpener(std::string_view haptic);
// UsbLibrary::watch; empty where there is no libusb, either.
std::shared_ptr<void> watchUsb(std::function<void()> changed);

// What `haptic` says of a probe (docs/usb_protocol.md): whatever its numbers, its name begins so.
inline constexpr std::string_view kProbeName = "Patina probe";

// The maker or model of a haptic device; empty if vendor and product are none that we know.
std::string_view hapticName(std::uint16_t vendor, std::uint16_t product);

// The first line of a file of the kernel's, fit for a terminal; empty where there is none.
std::string kernelLine(const std::filesystem::path& file);

// One line for a person; for a missing permission it holds the udev rule to add.
std::string usbAdvice(UsbRefusal refusal, std::uint16_t vendor, std::uint16_t product);
std::string usbNumbers(std::uint16_t vendor, std::uint16_t product); // "0403:cb48"

// Rules of udev for all devices that we know, a file's text: whoever sits at the machine may open
// them. data/70-patina.rules is the same.
inline constexpr const char* kUdevFile = "70-patina.rules";
std::string udevRules();

} // namespace patina
