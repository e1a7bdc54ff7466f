// How a driver talks to an opened USB device; what is behind it may be a bus or a script.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace patina {

enum class UsbResult : std::uint8_t {
  ok,
  timeout, // some bytes may have gone over
  stall,   // the device refuses the request
  gone,    // unplugged
  failed,  // anything else
};

struct UsbCount {
  UsbResult result = UsbResult::ok;
  std::size_t bytes = 0; // that went over, whatever the result
};

// The eight bytes that begin a control transfer, as USB 2.0 9.3 names them; bit 7 of request_type
// says which way: set, from the device.
struct UsbRequest {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

// One device, opened; closed when destroyed. Errors are values: nothing throws, so that a servo may
// call it, and it waits no longer than timeout_ms (at least 1; .2 s more where the system fails).
// 4096 bytes a call at most. One thread at a time.
class UsbTransport {
 public:
  virtual ~UsbTransport() = default;
  // Before any other call; takes the interface from a kernel driver, which has it back at the end.
  virtual UsbResult claim(int interface_number) noexcept = 0;
  virtual UsbCount controlOut(const UsbRequest& request, std::span<const std::byte> data,
                              unsigned timeout_ms) noexcept = 0;
  virtual UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                             unsigned timeout_ms) noexcept = 0;
  // Bulk or interrupt, whichever the endpoint is; bit 7 of its address is set for reading.
  virtual UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                         unsigned timeout_ms) noexcept = 0;
  virtual UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                        unsigned timeout_ms) noexcept = 0;
};

} // namespace patina
