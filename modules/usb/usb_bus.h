// What hangs on the USB bus, and which of it is a haptic device by vendor and product.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace patina {

struct UsbDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;      // from the device, or "vendor:product" where it may not be opened
  std::string haptic;    // "Force Dimension", "Novint Falcon" ...; empty if it is none that we know
  bool openable = false;  // by this user
  std::string advice;    // what to do if not: permissions, a driver that holds it
};

// Every device on the bus. Throws DeviceError if the bus cannot be read at all.
std::vector<UsbDevice> listUsbDevices();

}  // namespace patina
