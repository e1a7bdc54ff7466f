// Messages between an emulated device (emulated_plug.h) and the program that opens it through
// usbfs_shim.cpp. The socket replaces a node of /dev/bus/usb: SOCK_SEQPACKET, one
// message per packet, followed by the data of the URB.
#pragma once

#include <cstddef>
#include <cstdint>

namespace patina {

struct UsbfsMessage {
  enum Kind : std::uint32_t {
    // Messages to the device:
    submit,  // an URB: type, endpoint; `bytes` follow or are requested
    discard, // cancels the URB with this id
    claim,   // interface number in `endpoint`
    release,
    clear_halt, // uses `endpoint`
    // Messages to the program:
    hello, // sent once: 0, or the reason why opening fails
    reply, // answers claim, release and clear_halt
    done,  // completes the URB with this id; received bytes follow
  };
  std::uint32_t kind = submit;
  std::uint32_t id = 0;
  std::int32_t status = 0; // 0 or -errno, as from the kernel
  std::uint8_t type = 0;   // USBDEVFS_URB_TYPE_
  std::uint8_t endpoint = 0;
  std::uint32_t bytes = 0; // bytes transferred or requested
};
inline constexpr std::size_t kUsbfsSetup = 8; // setup bytes before a control transfer's data
inline constexpr std::size_t kMaxUrbBytes = 4096 + kUsbfsSetup; // largest URB [bytes]
inline constexpr const char* kUsbfsFolder =
    "PATINA_USBFS"; // environment variable with the shim's folder

} // namespace patina
