// An emulated device on an emulated bus: what libusb asks of the kernel is answered from a folder
// and a socket, so that programs which know nothing of it open it as any other.
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
    bool interrupt = false; // else bulk
  };
  std::vector<Endpoint> endpoints{};
  // What it refuses: to be opened, to be claimed, or, as `other`, every transfer after that, as
  // behind a hub that has dropped it.
  std::optional<UsbRefusal> refusal{};
  double halt_time = 0; // [s], that the kernel takes to end a halt
};

// Plugged in as long as it lives. `folder` has the bus: sys/bus/usb and dev/bus/usb in it, as the
// kernel has them; several may share it. A program sees it that runs under
// tests/support/usbfs_shim.cpp, with PATINA_USBFS naming the folder.
class EmulatedPlug {
 public:
  // `open` is called for each program that claims it, in a thread of its own, which has the
  // scheduling of the caller's. Throws FileError where the folder cannot have it.
  EmulatedPlug(const std::filesystem::path& folder, const EmulatedUsb& device,
               std::function<std::unique_ptr<UsbTransport>()> open);
  ~EmulatedPlug();
  EmulatedPlug(EmulatedPlug&&) noexcept;
  std::size_t claims() const noexcept;                // so far
  const std::filesystem::path& node() const noexcept; // its socket

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
