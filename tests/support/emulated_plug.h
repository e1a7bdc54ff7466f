// An emulated USB device. A folder and a socket stand in for the kernel's files, so that unmodified
// programs open it through libusb like any other device.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "usb/usb_library.h"

namespace patina {

struct EmulatedUsb {
  std::uint16_t vendor = 0, product = 0, release = 0x0100;
  std::string maker{}, name{}, serial{};
  int interface_class = 255;
  struct Endpoint {
    std::uint8_t address = 0x81;
    bool interrupt = false; // false: bulk
  };
  std::vector<Endpoint> endpoints{};
  // Emulated failure: opening, claiming or, with `other`, every later transfer fails.
  std::optional<UsbAccessError> refusal{};
  double halt_time = 0; // time that the kernel takes to clear a halt [s]
};

// Attached to the bus while the object exists. `folder` contains the bus (sys/bus/usb and
// dev/bus/usb, laid out as the kernel's) and may be shared by several devices. Programs see the
// device if they run under tests/support/usbfs_shim.cpp with PATINA_USBFS set to the folder.
class EmulatedUsbDevice {
 public:
  // Calls `open` for each program that claims the device, in a separate thread with the caller's
  // scheduling policy. Throws FileError if the folder cannot contain the bus.
  EmulatedUsbDevice(const std::filesystem::path& folder, const EmulatedUsb& device,
                    std::function<std::unique_ptr<UsbTransport>()> open);
  ~EmulatedUsbDevice();
  EmulatedUsbDevice(EmulatedUsbDevice&&) noexcept;
  std::size_t claims() const noexcept;                // number of claims
  const std::filesystem::path& node() const noexcept; // path of its socket

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
