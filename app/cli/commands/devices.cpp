#include <algorithm>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/devices/device_catalog.h"
#include "haptics/servo/latency.h"
#include "usb/usb_bus.h"

namespace patina::cli {

namespace {

struct DevicesOptions {
  bool diagnose = false;
};

const Keys kDeviceKeys = {{"name", "", ""},
                          {"kind", "", "", "built-in or usb"},
                          {"device", "", "", "of the scene"},
                          {"max_force", "N", ""},
                          {"max_stiffness", "N/m", ""},
                          {"note", "", ""},
                          {"id", "", "", "of USB, as those that follow"},
                          {"haptic", "", ""},
                          {"openable", "", ""},
                          {"advice", "", ""}};
const Keys kDevicesKeys = {{"devices", "", "devices", "", Shown::never, kDeviceKeys},
                           {"policy", "", "servo", "its scheduling, with --diagnose"},
                           {"realtime", "", "real time", "with --diagnose", Shown::never}};

Json known(const std::optional<double>& limit) {
  return limit ? Json(*limit) : Json();
}

void setLimits(const DeviceEntry& device, Json& entry) {
  entry.set("device", device.name);
  entry.set("max_force", known(device.limits.max_force));
  entry.set("max_stiffness", known(device.limits.max_stiffness));
  entry.set("note", device.note);
}

void addBuiltIn(Json& list, Report& report) {
  for (const DeviceEntry& device : deviceCatalog()) {
    if (!device.usb.empty()) continue;
    Json entry = Json::object();
    entry.set("name", device.name).set("kind", "built-in");
    setLimits(device, entry);
    list.push(entry);
    report.tell(device.name, std::string("built in; ") + device.note);
  }
}

// Haptic devices always, everything else on the bus only when asked.
void addUsb(bool diagnose, Json& list, Report& report) {
  std::vector<UsbDevice> devices;
  try {
    devices = listUsbDevices();
  } catch (const DeviceError& error) {
    report.tell("USB", error.what());
    return;
  }
  bool any = false;
  for (const UsbDevice& device : devices) {
    any = any || !device.haptic.empty();
    if (device.haptic.empty() && !diagnose) continue;
    Json entry = Json::object();
    entry.set("name", device.name)
        .set("kind", "usb")
        .set("id", usbNumbers(device.vendor, device.product));
    entry.set("haptic", device.haptic).set("openable", device.openable);
    entry.set("advice", device.advice);
    const auto driver = std::ranges::find(deviceCatalog(), device.haptic, &DeviceEntry::usb);
    const bool driven = !device.haptic.empty() && driver != deviceCatalog().end();
    if (driven) setLimits(*driver, entry);
    list.push(entry);
    std::string text = device.name;
    if (!device.haptic.empty())
      text += " (" + device.haptic + "; " +
              (driven ? std::string("device = ") + driver->name
                      : "recognised; this version renders no force on it") +
              ")";
    if (!device.advice.empty()) text += "; " + device.advice;
    report.tell(usbNumbers(device.vendor, device.product), text);
  }
  if (!any) report.tell("USB", "no haptic device is attached");
}

int runDevices(const DevicesOptions& options, Console& console) {
  Json list = Json::array();
  Report report(kDevicesKeys);
  addBuiltIn(list, report);
  addUsb(options.diagnose, list, report);
  report.set("devices", list);
  if (options.diagnose) {
    const Latency latency = measureLatency(0.2);
    report.set("policy", latency.policy).set("realtime", latency.realtime);
    if (!latency.realtime)
      report.tell("advice", "for a steady 1 kHz allow real-time priority: add the line "
                            "'@audio - rtprio 60' to /etc/security/limits.conf, join that "
                            "group, log in again");
  }
  console.report(report);
  return kDone;
}

} // namespace

Command devicesCommand() {
  auto options = std::make_shared<DevicesOptions>();
  return {.name = "devices",
          .summary = "what is attached, what is wrong, what to do",
          .description = "Lists the built-in devices and the haptic devices on the USB bus. "
                         "--diagnose lists everything on the bus, with what keeps it from being "
                         "opened, and tries the servo's scheduling policy.",
          .examples = {"patina devices --diagnose"},
          .keys = kDevicesKeys,
          .arguments = {{"--diagnose", "", "", "", "Say what is wrong and what to do.",
                         into(options->diagnose)}},
          .run = [options](Console& console) { return runDevices(*options, console); }};
}

} // namespace patina::cli
