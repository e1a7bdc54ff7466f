#include "usb/usb_bus.h"

#include <array>
#include <cstdio>
#include <libusb.h>
#include <memory>

#include "core/error.h"

namespace patina {
namespace {

struct CloseContext {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
struct FreeList {
  void operator()(libusb_device** list) const { libusb_free_device_list(list, 1); }
};

std::string numbers(const libusb_device_descriptor& descriptor) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04x:%04x", static_cast<unsigned>(descriptor.idVendor),
                static_cast<unsigned>(descriptor.idProduct));
  return text.data();
}

std::string text(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 256> buffer{};
  const int length = index == 0
                         ? 0
                         : libusb_get_string_descriptor_ascii(handle, index, buffer.data(),
                                                              static_cast<int>(buffer.size()));
  std::string out;
  // A device may send any bytes; they end on a terminal.
  for (int i = 0; i < length; ++i) {
    const unsigned char c = buffer[static_cast<std::size_t>(i)];
    out += c < 0x20 || c > 0x7e ? '?' : static_cast<char>(c);
  }
  return out;
}

UsbRefusal refusalOf(int code) {
  switch (code) {
  case LIBUSB_ERROR_ACCESS:
    return UsbRefusal::permission;
  case LIBUSB_ERROR_BUSY:
    return UsbRefusal::held_by_driver;
  case LIBUSB_ERROR_NO_DEVICE:
    return UsbRefusal::gone;
  default:
    return UsbRefusal::other;
  }
}

UsbDevice describe(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbDevice out;
  out.vendor = descriptor.idVendor;
  out.product = descriptor.idProduct;
  out.name = numbers(descriptor);
  out.haptic = hapticName(out.vendor, out.product);

  libusb_device_handle* raw = nullptr;
  if (const int code = libusb_open(device, &raw); code != LIBUSB_SUCCESS) {
    out.advice = usbAdvice(refusalOf(code), out.vendor, out.product);
    return out;
  }
  const std::unique_ptr<libusb_device_handle, CloseHandle> handle(raw);
  out.openable = true;
  const std::string maker = text(raw, descriptor.iManufacturer);
  const std::string product = text(raw, descriptor.iProduct);
  const std::string name =
      maker.empty() || product.empty() ? maker + product : maker + " " + product;
  if (!name.empty()) out.name = name;
  // Reading its name works all the same, claiming it would not.
  if (!out.haptic.empty() && libusb_kernel_driver_active(raw, 0) == 1)
    out.advice = usbAdvice(UsbRefusal::held_by_driver, out.vendor, out.product);
  return out;
}

} // namespace

std::vector<UsbDevice> listUsbDevices() {
  libusb_context* raw = nullptr;
  if (const int code = libusb_init(&raw); code != LIBUSB_SUCCESS) {
    throw DeviceError(std::string("the USB bus cannot be read (") + libusb_strerror(code) +
                      "): is there a /dev/bus/usb? A container must be given it.");
  }
  const std::unique_ptr<libusb_context, CloseContext> context(raw);

  libusb_device** items = nullptr;
  const ssize_t count = libusb_get_device_list(raw, &items);
  if (count < 0) {
    throw DeviceError(std::string("the USB bus cannot be listed: ") +
                      libusb_strerror(static_cast<int>(count)));
  }
  const std::unique_ptr<libusb_device*[], FreeList> list(items);

  std::vector<UsbDevice> devices;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[static_cast<std::size_t>(i)], &descriptor) == 0)
      devices.push_back(describe(list[static_cast<std::size_t>(i)], descriptor));
  }
  return devices;
}

} // namespace patina
