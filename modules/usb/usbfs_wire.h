// What goes over the socket that stands for a node of /dev/bus/usb: between an emulated device
// (emulated_plug.h) and the program that is made to see it (tests/support/usbfs_shim.cpp). One
// message a packet, SOCK_SEQPACKET; what an URB carries follows it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace patina {

struct UsbfsMessage {
  enum Kind : std::uint32_t {
    // To the device.
    submit,     // an URB: type, endpoint; bytes that follow, or that are asked for
    discard,    // the URB of this id
    claim,      // interface `endpoint`
    release,    //
    clear_halt, // of `endpoint`
    // To the program.
    hello, // once, with 0 or why it may not be opened
    reply, // to claim, release and clear_halt
    done,  // the URB of this id, with the bytes that it brought
  };
  std::uint32_t kind = submit;
  std::uint32_t id = 0;
  std::int32_t status = 0; // 0 or -errno, as the kernel has it
  std::uint8_t type = 0;   // USBDEVFS_URB_TYPE_
  std::uint8_t endpoint = 0;
  std::uint32_t bytes = 0; // that went over, or are asked for
};
inline constexpr std::size_t kUsbfsSetup = 8; // bytes before a control transfer's data
inline constexpr std::size_t kUsbfsMost = 4096 + kUsbfsSetup; // bytes of an URB
inline constexpr const char* kUsbfsFolder = "PATINA_USBFS";   // names the folder to the shim

} // namespace patina
