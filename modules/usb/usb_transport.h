// Transfers with an opened USB device; implementations are a bus or, in tests, a script.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace patina {

enum class UsbResult : std::uint8_t {
  ok,
  timeout, // some bytes may have been transferred
  stall,   // the device rejects the request
  gone,    // unplugged
  failed,  // anything else
};

struct UsbCount {
  UsbResult result = UsbResult::ok;
  std::size_t bytes = 0; // bytes transferred, also after a failure
};

// Setup packet (USB 2.0, 9.3). Bit 7 of request_type set: device to host.
struct UsbRequest {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

// An opened device; the destructor closes it. No call throws, so that the servo may call them. A
// call takes at most timeout_ms (at least 1; 0.2 s more if the system fails) and transfers at most
// 4096 bytes. One thread at a time.
class UsbTransport {
 public:
  virtual ~UsbTransport() = default;
  // Must precede other calls. Detaches a kernel driver; the destructor attaches it again.
  virtual UsbResult claim(int interface_number) noexcept = 0;
  virtual UsbCount controlOut(const UsbRequest& request, std::span<const std::byte> data,
                              unsigned timeout_ms) noexcept = 0;
  virtual UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                             unsigned timeout_ms) noexcept = 0;
  // Bulk or interrupt, by the endpoint's type; bit 7 of the address is set for reading.
  virtual UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                         unsigned timeout_ms) noexcept = 0;
  virtual UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                        unsigned timeout_ms) noexcept = 0;
};

} // namespace patina
