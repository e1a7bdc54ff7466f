// A USB device that accepts control transfers out and answers none in; derived classes implement
// reads and writes.
#pragma once

#include "usb/usb_transport.h"

namespace patina::test {

class MuteTransport : public UsbTransport {
 public:
  UsbResult claim(int) noexcept override { return UsbResult::ok; }
  UsbCount controlOut(const UsbRequest&, std::span<const std::byte>, unsigned) noexcept override {
    return {};
  }
  UsbCount controlIn(const UsbRequest&, std::span<std::byte>, unsigned) noexcept override {
    return {UsbResult::stall, 0};
  }
};

} // namespace patina::test
