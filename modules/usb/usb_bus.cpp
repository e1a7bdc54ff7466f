#include "usb/usb_bus.h"

#include "core/error.h"

namespace patina {
namespace {

const UsbLibrary& library() {
  std::string cause;
  const UsbLibrary* table = usbLibrary(cause);
  if (!table) throw DeviceError(cause);
  return *table;
}

UsbDevice described(const UsbFound& found) {
  UsbDevice out;
  out.vendor = found.vendor;
  out.product = found.product;
  out.name = found.name.empty() ? usbNumbers(found.vendor, found.product) : found.name;
  out.haptic = hapticName(found.vendor, found.product);
  out.openable = found.openable;
  out.bus = found.bus;
  out.address = found.address;
  out.megabits = found.megabits;
  // Ours take it from the kernel's driver by themselves; it is told of those we have no driver for.
  if (!found.openable)
    out.advice = usbAdvice(found.refusal.value_or(UsbRefusal::other), found.vendor, found.product);
  else if (found.driver_holds && !out.haptic.empty())
    out.advice = usbAdvice(UsbRefusal::held_by_driver, found.vendor, found.product);
  return out;
}

} // namespace

std::vector<UsbDevice> listUsbDevices() {
  std::string cause;
  std::vector<UsbDevice> devices;
  for (const UsbFound& found : library().list(cause)) devices.push_back(described(found));
  if (!cause.empty()) throw DeviceError(cause);
  return devices;
}

std::unique_ptr<UsbTransport> openUsb(std::uint16_t vendor, std::uint16_t product) {
  std::optional<UsbRefusal> refusal;
  std::string cause;
  std::unique_ptr<UsbTransport> usb = library().open(vendor, product, refusal, cause);
  if (usb) return usb;
  if (!cause.empty()) throw DeviceError(cause);
  const std::string_view known = hapticName(vendor, product);
  const std::string who = (known.empty() ? "the device" : std::string(known)) + " (USB " +
                          usbNumbers(vendor, product) + ")";
  throw DeviceError(refusal ? who + ": " + usbAdvice(*refusal, vendor, product)
                            : who + " is not attached: plug it in, and its power supply too");
}

std::unique_ptr<UsbTransport> openUsb(std::string_view haptic) {
  for (const UsbDevice& device : listUsbDevices())
    if (device.haptic == haptic) return openUsb(device.vendor, device.product);
  throw DeviceError("no " + std::string(haptic) +
                    " is attached: plug it in, and its power supply too");
}

} // namespace patina
