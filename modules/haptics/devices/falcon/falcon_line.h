// The serial line inside a Falcon: an FTDI bridge on USB, two status bytes before each packet.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "haptics/devices/link/device_clock.h"
#include "usb/usb_transport.h"

namespace patina {

inline constexpr std::uint16_t kFalconVendor = 0x0403, kFalconProduct = 0xcb48;

// What came, and how it ended; `surplus` bytes came behind what was asked for, and are lost.
struct LineRead {
  UsbResult result = UsbResult::ok; // timeout: less than asked for
  std::size_t bytes = 0, surplus = 0;
};

class FalconLine {
 public:
  FalconLine(std::unique_ptr<UsbTransport> usb, std::shared_ptr<DeviceClock> clock)
      : usb_(std::move(usb)), clock_(std::move(clock)) {}

  UsbResult claim() noexcept { return usb_->claim(0); }
  // The three states in which the line is used; each begins with nothing in its buffers.
  UsbResult toBootLoader() noexcept; // 9600 baud, its processor reset
  UsbResult toLoading() noexcept;    // 140 kbaud
  UsbResult toRunning() noexcept;    // 1.5 Mbaud, packets after 1 ms at the latest
  UsbResult purge() noexcept;        // what the bridge holds in both directions

  UsbResult send(std::span<const std::byte> bytes) noexcept; // 1 ms at most
  // Fills `into`, waiting `seconds` at most; a transport waits for whole milliseconds, so that the
  // last one of them may be missing.
  LineRead receive(std::span<std::byte> into, double seconds) noexcept;
  // Bytes that come until two packets in a row hold none, waiting `seconds` at most; ok: it is
  // quiet.
  LineRead listen(double seconds) noexcept;

 private:
  UsbResult set(std::uint8_t request, std::uint16_t value) noexcept;

  std::unique_ptr<UsbTransport> usb_;
  std::shared_ptr<DeviceClock> clock_;
};

} // namespace patina
