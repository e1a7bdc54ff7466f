// One opened device over libusb, with a context of its own.
#pragma once

#include <libusb.h>
#include <memory>

#include "usb/usb_transport.h"

namespace patina {

struct CloseContext {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using Context = std::unique_ptr<libusb_context, CloseContext>;
using Handle = std::unique_ptr<libusb_device_handle, CloseHandle>;

// nullptr if there is no memory for its transfers.
std::unique_ptr<UsbTransport> makeLibusbTransport(Context context, Handle handle);

} // namespace patina
