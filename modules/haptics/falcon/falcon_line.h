// Serial line inside a Falcon: an FTDI bridge on USB with two status bytes before each packet.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "haptics/link/device_clock.h"
#include "usb/usb_transport.h"

namespace patina {

inline constexpr std::uint16_t kFalconVendor = 0x0403, kFalconProduct = 0xcb48;

// Result of a read; `surplus` bytes followed the requested ones and are discarded.
struct LineRead {
  UsbResult result = UsbResult::ok; // timeout: fewer bytes than requested
  std::size_t bytes = 0, surplus = 0;
};

class FalconLine {
 public:
  FalconLine(std::unique_ptr<UsbTransport> usb, std::shared_ptr<DeviceClock> clock)
      : usb_(std::move(usb)), clock_(std::move(clock)) {}

  UsbResult claim() noexcept { return usb_->claim(0); }
  // The three modes of the line; each starts with empty buffers.
  UsbResult toBootLoader() noexcept; // 9600 baud, processor reset
  UsbResult toLoading() noexcept;    // 140 kbaud
  UsbResult toRunning() noexcept;    // 1.5 Mbaud, packets after at most 1 ms
  UsbResult purge() noexcept;        // discards the bridge's buffers in both directions

  UsbResult send(std::span<const std::byte> bytes) noexcept; // takes at most 1 ms
  // Fills `into` within `seconds`, in whole milliseconds, of which the last may be missing.
  LineRead receive(std::span<std::byte> into, double seconds) noexcept;
  // Discards bytes until two packets in a row are empty (ok), for at most `seconds`.
  LineRead listen(double seconds) noexcept;

 private:
  UsbResult set(std::uint8_t request, std::uint16_t value) noexcept;

  std::unique_ptr<UsbTransport> usb_;
  std::shared_ptr<DeviceClock> clock_;
};

} // namespace patina
