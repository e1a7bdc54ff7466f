// What hangs on the USB bus, and which of it is a haptic device by vendor and product.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

struct UsbDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;      // from the device, or "vendor:product" where it may not be opened
  std::string haptic;    // "Force Dimension", "Novint Falcon" ...; empty if it is none that we know
  bool openable = false; // by this user
  std::string advice;    // what to do if not: permissions, a driver that holds it
};

// Every device on the bus; an empty list if there is a bus with nothing on it. Throws DeviceError
// if the bus cannot be read at all, as in a container without /dev/bus/usb. Any thread; slow.
std::vector<UsbDevice> listUsbDevices();

// The maker or model of a haptic device; empty if vendor and product are none that we know.
std::string_view hapticName(std::uint16_t vendor, std::uint16_t product);

// Why a device could not be opened, as libusb sees it.
enum class UsbRefusal : std::uint8_t { permission, held_by_driver, gone, other };

// One line for a person; for a missing permission it holds the udev rule to add.
std::string usbAdvice(UsbRefusal refusal, std::uint16_t vendor, std::uint16_t product);

} // namespace patina
