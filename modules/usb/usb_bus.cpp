#include "usb/usb_bus.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace patina {
namespace {

const UsbLibrary& library() {
  std::string cause;
  const UsbLibrary* table = usbLibrary(cause);
  if (!table) throw DeviceError(cause);
  return *table;
}

// Reads name and serial number from sysfs for a device that may not be opened.
void readSysfs(UsbDevice& device) {
  namespace fs = std::filesystem;
  std::error_code code;
  for (const auto& item : fs::directory_iterator("/sys/bus/usb/devices", code)) {
    if (readSysfsLine(item.path() / "busnum") != std::to_string(device.bus) ||
        readSysfsLine(item.path() / "devnum") != std::to_string(device.address))
      continue;
    const std::string maker = readSysfsLine(item.path() / "manufacturer"),
                      product = readSysfsLine(item.path() / "product");
    device.name = maker.empty() || product.empty() ? maker + product : maker + " " + product;
    device.serial = readSysfsLine(item.path() / "serial");
    return;
  }
}

UsbDevice described(const UsbDescriptor& found) {
  UsbDevice out;
  out.vendor = found.vendor;
  out.product = found.product;
  out.release = found.release;
  out.openable = found.openable;
  out.bus = found.bus;
  out.address = found.address;
  out.megabits = found.megabits;
  out.name = found.name;
  out.serial = found.serial;
  if (!found.openable) readSysfs(out);
  out.haptic = out.name.find(kProbeName) != std::string::npos
                   ? kProbeName
                   : hapticName(found.vendor, found.product);
  if (out.name.empty()) out.name = vendorProductText(found.vendor, found.product);
  // Claiming detaches a kernel driver and releasing attaches it again, so it prevents nothing.
  if (!found.openable) out.refusal = found.refusal.value_or(UsbAccessError::other);
  if (out.refusal) out.advice = usbAdvice(*out.refusal, found.vendor, found.product);
  return out;
}

} // namespace

std::string readSysfsLine(const std::filesystem::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text);
  for (char& c : text) c = c < 0x20 || c > 0x7e ? '?' : c; // shown on a terminal
  return text;
}

std::vector<UsbDevice> listUsbDevices() {
  std::string cause;
  std::vector<UsbDevice> devices;
  for (const UsbDescriptor& found : library().list(cause)) devices.push_back(described(found));
  if (!cause.empty()) throw DeviceError(cause);
  return devices;
}

std::unique_ptr<UsbTransport> openUsb(const UsbDevice& device) {
  std::optional<UsbAccessError> refusal;
  std::string cause;
  std::unique_ptr<UsbTransport> usb = library().open(
      [&](const UsbDescriptor& found) {
        return found.bus == device.bus && found.address == device.address;
      },
      refusal, cause);
  if (usb) return usb;
  if (!cause.empty()) throw DeviceError(cause);
  const std::string who =
      device.name + " (USB " + vendorProductText(device.vendor, device.product) + ")";
  if (refusal) throw DeviceError(who + ": " + usbAdvice(*refusal, device.vendor, device.product));
  throw NotAttached(who + " is not attached: plug it in, and its power supply too");
}

std::unique_ptr<UsbTransport> openUsb(std::string_view haptic) {
  std::optional<UsbDevice> refused;
  for (const UsbDevice& device : listUsbDevices()) {
    if (device.haptic != haptic) continue;
    if (device.openable) return openUsb(device);
    if (!refused) refused = device;
  }
  if (refused) return openUsb(*refused); // throws the reason
  throw NotAttached("no " + std::string(haptic) +
                    " is attached: plug it in, and its power supply too");
}

std::shared_ptr<void> watchUsb(std::function<void()> changed) {
  std::string cause;
  const UsbLibrary* table = usbLibrary(cause);
  return table ? table->watch(std::move(changed)) : nullptr;
}

std::function<std::unique_ptr<UsbTransport>()> usbOpener(std::string_view haptic) {
  using Clock = std::chrono::steady_clock;
  struct Seen {
    std::atomic<bool> changed{false};
    std::shared_ptr<void> watch{}; // created when no device is found first
    std::optional<NotAttached> absent{};
    Clock::time_point looked{};
  };
  return [haptic, seen = std::make_shared<Seen>()]() -> std::unique_ptr<UsbTransport> {
    const bool changed = seen->changed.exchange(false);
    if (seen->absent && !changed && Clock::now() - seen->looked < std::chrono::seconds(2))
      throw NotAttached(*seen->absent);
    seen->absent.reset();
    try {
      return openUsb(haptic);
    } catch (const NotAttached& absent) {
      // Arrivals between the search and the watch's start cause another search at the next call.
      if (!seen->watch) {
        seen->watch = watchUsb([all = seen.get()] { all->changed = true; });
        seen->changed = true;
      }
      seen->looked = Clock::now();
      if (!seen->watch) throw;
      seen->absent = absent;
      seen->absent->notified_by_hotplug = true;
      throw NotAttached(*seen->absent);
    }
  };
}

} // namespace patina
