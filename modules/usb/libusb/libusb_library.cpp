// The library that is loaded: the bus as libusb sees it.
#include "usb/usb_library.h"

#include <array>

#include "usb/libusb/libusb_transport.h"
#include "usb/libusb/libusb_watch.h"

namespace patina {
namespace {

struct List {
  libusb_device** items = nullptr;
  ssize_t count = 0;
  ~List() {
    if (items) libusb_free_device_list(items, 1);
  }
};

Context openContext(std::string& cause) {
  libusb_context* raw = nullptr;
  const int code = libusb_init(&raw);
  if (code == LIBUSB_SUCCESS) return Context(raw);
  cause = std::string("the USB bus cannot be read (") + libusb_strerror(code) +
          "): is there a /dev/bus/usb? A container must be given it.";
  return nullptr;
}

bool fill(List& list, libusb_context* context, std::string& cause) {
  list.count = libusb_get_device_list(context, &list.items);
  if (list.count >= 0) return true;
  cause =
      std::string("the USB bus cannot be listed: ") + libusb_strerror(static_cast<int>(list.count));
  return false;
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

double megabitsOf(libusb_device* device) {
  switch (libusb_get_device_speed(device)) {
  case LIBUSB_SPEED_LOW:
    return 1.5;
  case LIBUSB_SPEED_FULL:
    return 12;
  case LIBUSB_SPEED_HIGH:
    return 480;
  case LIBUSB_SPEED_SUPER:
    return 5000;
  case LIBUSB_SPEED_SUPER_PLUS:
    return 10000;
  default:
    return 0;
  }
}

// What is known without opening it.
UsbFound numbered(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbFound out;
  out.vendor = descriptor.idVendor;
  out.product = descriptor.idProduct;
  out.bus = libusb_get_bus_number(device);
  out.address = libusb_get_device_address(device);
  out.megabits = megabitsOf(device);
  out.release = descriptor.bcdDevice;
  return out;
}

UsbFound found(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbFound out = numbered(device, descriptor);
  libusb_device_handle* raw = nullptr;
  if (const int code = libusb_open(device, &raw); code != LIBUSB_SUCCESS) {
    out.refusal = refusalOf(code);
    return out;
  }
  const Handle handle(raw);
  out.openable = true;
  const std::string maker = text(raw, descriptor.iManufacturer);
  const std::string product = text(raw, descriptor.iProduct);
  out.name = maker.empty() || product.empty() ? maker + product : maker + " " + product;
  out.serial = text(raw, descriptor.iSerialNumber);
  return out;
}

std::vector<UsbFound> listAll(std::string& cause) {
  std::vector<UsbFound> devices;
  const Context context = openContext(cause);
  List list;
  if (!context || !fill(list, context.get(), cause)) return devices;
  for (ssize_t i = 0; i < list.count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list.items[i], &descriptor) == 0)
      devices.push_back(found(list.items[i], descriptor));
  }
  return devices;
}

std::unique_ptr<UsbTransport> openFirst(const std::function<bool(const UsbFound&)>& wanted,
                                        std::optional<UsbRefusal>& refusal, std::string& cause) {
  Context context = openContext(cause);
  if (!context) return nullptr;
  Handle handle;
  {
    List list;
    if (!fill(list, context.get(), cause)) return nullptr;
    for (ssize_t i = 0; i < list.count && !handle; ++i) {
      libusb_device_descriptor descriptor{};
      if (libusb_get_device_descriptor(list.items[i], &descriptor) != 0 ||
          !wanted(numbered(list.items[i], descriptor)))
        continue;
      libusb_device_handle* raw = nullptr;
      const int code = libusb_open(list.items[i], &raw);
      if (code == LIBUSB_SUCCESS)
        handle.reset(raw);
      else
        refusal = refusalOf(code);
    }
  }
  if (!handle) return nullptr;
  auto transport = makeLibusbTransport(std::move(context), std::move(handle));
  if (!transport) cause = "no memory for a USB transfer: close other programs";
  return transport;
}

} // namespace
} // namespace patina

extern "C" __attribute__((visibility("default"))) const patina::UsbLibrary* patinaUsbLibrary() {
  static const patina::UsbLibrary kLibrary{&patina::listAll, &patina::openFirst,
                                           &patina::watchLibusb};
  return &kLibrary;
}
