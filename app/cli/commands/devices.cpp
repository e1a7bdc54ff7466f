#include <algorithm>
#include <cstdio>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/devices/device_catalog.h"
#include "haptics/servo/latency.h"
#ifdef PATINA_HAS_USB
#include "usb/usb_bus.h"
#endif

namespace patina::cli {

namespace {

struct DevicesOptions {
  bool diagnose = false;
};

Json known(const std::optional<double>& limit) {
  return limit ? Json(*limit) : Json();
}

void setLimits(const DeviceEntry& device, Json& entry) {
  entry.set("device", device.name);
  entry.set("max_force", known(device.limits.max_force));
  entry.set("max_stiffness", known(device.limits.max_stiffness));
  entry.set("note", device.note);
}

void addBuiltIn(Json& list, TextRows& rows) {
  for (const DeviceEntry& device : deviceCatalog()) {
    if (!device.usb.empty()) continue;
    Json entry = Json::object();
    entry.set("name", device.name);
    entry.set("kind", "built-in");
    setLimits(device, entry);
    list.push(entry);
    rows.emplace_back(device.name, std::string("built in; ") + device.note);
  }
}

#ifdef PATINA_HAS_USB
std::string usbId(const UsbDevice& device) {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", device.vendor, device.product);
  return text;
}
#endif

// Haptic devices always, everything else on the bus only when asked.
void addUsb(bool diagnose, Json& list, TextRows& rows) {
#ifdef PATINA_HAS_USB
  std::vector<UsbDevice> devices;
  try {
    devices = listUsbDevices();
  } catch (const DeviceError& error) {
    rows.emplace_back("USB", error.what());
    return;
  }
  bool any = false;
  for (const UsbDevice& device : devices) {
    any = any || !device.haptic.empty();
    if (device.haptic.empty() && !diagnose) continue;
    Json entry = Json::object();
    entry.set("name", device.name);
    entry.set("kind", "usb");
    entry.set("id", usbId(device));
    entry.set("haptic", device.haptic);
    entry.set("openable", device.openable);
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
    rows.emplace_back(usbId(device), text);
  }
  if (!any) rows.emplace_back("USB", "no haptic device is attached");
#else
  (void)diagnose;
  (void)list;
  rows.emplace_back("USB", "this build cannot look: it was configured with PATINA_USB=OFF");
#endif
}

int runDevices(const DevicesOptions& options, Console& console) {
  Json list = Json::array();
  TextRows rows;
  addBuiltIn(list, rows);
  addUsb(options.diagnose, list, rows);
  Json json = Json::object();
  json.set("devices", list);
  if (options.diagnose) {
    const Latency latency = measureLatency(0.2);
    json.set("policy", latency.policy);
    json.set("realtime", latency.realtime);
    rows.emplace_back("servo", latency.policy);
    if (!latency.realtime)
      rows.emplace_back("advice", "for a steady 1 kHz allow real-time priority: add the line "
                                  "'@audio - rtprio 60' to /etc/security/limits.conf, join that "
                                  "group, log in again");
  }
  console.report(json, aligned(rows));
  return kDone;
}

} // namespace

Command devicesCommand() {
  auto options = std::make_shared<DevicesOptions>();
  Command command;
  command.name = "devices";
  command.summary = "what is attached, what is wrong, what to do";
  command.description =
      "Lists the built-in devices and the haptic devices on the USB bus. --diagnose lists "
      "everything on the bus, with what keeps it from being opened, and tries the servo's "
      "scheduling policy.\nJSON: devices (name, kind, and for USB: id, haptic, openable, advice); "
      "with --diagnose also policy, realtime.";
  command.examples = {"patina devices --diagnose"};
  command.flag("--diagnose", "Say what is wrong and what to do.", options->diagnose);
  command.run = [options](Console& console) { return runDevices(*options, console); };
  return command;
}

} // namespace patina::cli
