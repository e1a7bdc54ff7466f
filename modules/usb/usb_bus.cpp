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

// What the kernel tells of those that may not be asked.
void readSysfs(UsbDevice& device) {
  namespace fs = std::filesystem;
  std::error_code code;
  for (const auto& item : fs::directory_iterator("/sys/bus/usb/devices", code)) {
    if (kernelLine(item.path() / "busnum") != std::to_string(device.bus) ||
        kernelLine(item.path() / "devnum") != std::to_string(device.address))
      continue;
    const std::string maker = kernelLine(item.path() / "manufacturer"),
                      product = kernelLine(item.path() / "product");
    device.name = maker.empty() || product.empty() ? maker + product : maker + " " + product;
    device.serial = kernelLine(item.path() / "serial");
    return;
  }
}

UsbDevice described(const UsbFound& found) {
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
  if (out.name.empty()) out.name = usbNumbers(found.vendor, found.product);
  // A driver of the kernel's is no refusal: it gives way to a claim, and has the interface back.
  if (!found.openable) out.refusal = found.refusal.value_or(UsbRefusal::other);
  if (out.refusal) out.advice = usbAdvice(*out.refusal, found.vendor, found.product);
  return out;
}

} // namespace

std::string kernelLine(const std::filesystem::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text);
  for (char& c : text) c = c < 0x20 || c > 0x7e ? '?' : c; // it ends on a terminal
  return text;
}

std::vector<UsbDevice> listUsbDevices() {
  std::string cause;
  std::vector<UsbDevice> devices;
  for (const UsbFound& found : library().list(cause)) devices.push_back(described(found));
  if (!cause.empty()) throw DeviceError(cause);
  return devices;
}

std::unique_ptr<UsbTransport> openUsb(const UsbDevice& device) {
  std::optional<UsbRefusal> refusal;
  std::string cause;
  std::unique_ptr<UsbTransport> usb = library().open(
      [&](const UsbFound& found) {
        return found.bus == device.bus && found.address == device.address;
      },
      refusal, cause);
  if (usb) return usb;
  if (!cause.empty()) throw DeviceError(cause);
  const std::string who = device.name + " (USB " + usbNumbers(device.vendor, device.product) + ")";
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
  if (refused) return openUsb(*refused); // which says why not
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
    std::shared_ptr<void> watch{}; // begun when there first is none
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
      // What comes in between is told, and looked for at the next call.
      if (!seen->watch) {
        seen->watch = watchUsb([all = seen.get()] { all->changed = true; });
        seen->changed = true;
      }
      seen->looked = Clock::now();
      if (!seen->watch) throw;
      seen->absent = absent;
      seen->absent->told = true;
      throw NotAttached(*seen->absent);
    }
  };
}

} // namespace patina
