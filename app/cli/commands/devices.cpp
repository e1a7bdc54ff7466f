#include <filesystem>

#include "acquisition/sources/usb_probe.h"
#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/plugin/plugin_library.h"
#include "haptics/servo/latency.h"
#include "usb/usb_check.h"

namespace patina::cli {

namespace {

struct DevicesOptions {
  bool diagnose = false;
  bool install = false;
  std::filesystem::path rules; // target folder
};

const Keys kChannelKeys = {{"name", "", ""},
                           {"unit", "", ""},
                           {"low", "", "", "of its range"},
                           {"high", "", ""},
                           {"step", "", ""},
                           {"noise", "", ""},
                           {"calibrated", "", "", "days since 1970-01-01, 0: never"}};
const Keys kDeviceKeys = {
    {"name", "", ""},
    {"kind", "", "", "built-in, plug-in, usb or serial"},
    {"device", "", "", "of the scene"},
    {"max_force", "N", ""},
    {"max_stiffness", "N/m", ""},
    {"note", "", ""},
    {"id", "", "", "of USB, as those that follow"},
    {"haptic", "", ""},
    {"openable", "", ""},
    {"state", "", "", "ready, or what forbids it"},
    {"advice", "", ""},
    {"serial", "", ""},
    {"firmware", "", "", "the device's release"},
    {"cable_mbit", "Mbit/s", ""},
    {"round_trip_us", "us", "", "of its status, with --diagnose", Shown::always, percentileParts()},
    {"round_trips", "", "", "how many took up to 100, 200, 500 us, 1, 2, 5, 10 ms, and longer"},
    {"channels", "", "", "of a probe, with --diagnose", Shown::always, kChannelKeys}};
const Keys kDevicesKeys = {{"devices", "", "devices", "", Shown::never, kDeviceKeys},
                           {"rules", "", "rules", "of udev, that were written", Shown::if_any},
                           {"policy", "", "servo", "its scheduling, with --diagnose"},
                           {"realtime", "", "real time", "with --diagnose", Shown::never}};

Json known(const std::optional<double>& limit) {
  return limit ? Json(*limit) : Json();
}

void setLimits(const std::string& device, const DeviceLimits& limits, const std::string& note,
               Json& entry) {
  entry.set("device", device);
  entry.set("max_force", known(limits.max_force));
  entry.set("max_stiffness", known(limits.max_stiffness));
  entry.set("note", note);
}

void addBuiltIn(Json& list, Report& report) {
  for (const DeviceEntry& device : deviceCatalog()) {
    if (!device.usb.empty()) continue;
    Json entry = Json::object();
    entry.set("name", device.name).set("kind", "built-in");
    setLimits(device.name, device.limits, device.note, entry);
    list.push(entry);
    report.tell(device.name, std::string("built in; ") + device.note);
  }
}

void addPlugins(Json& list, Report& report) {
  for (const PluginFound& plugin : installedPlugins()) {
    Json entry = Json::object();
    const std::string device = "plugin:" + plugin.name;
    entry.set("name", plugin.problem.empty() ? plugin.caption : plugin.name).set("kind", "plug-in");
    if (plugin.problem.empty())
      setLimits(device, plugin.limits, plugin.note, entry);
    else
      entry.set("advice", plugin.problem);
    list.push(entry);
    report.tell(device, plugin.problem.empty() ? "plug-in; " + plugin.caption +
                                                     (plugin.note.empty() ? "" : ": " + plugin.note)
                                               : plugin.problem);
  }
}

std::string firmwareText(std::uint16_t release) {
  return std::to_string(release >> 12) + std::to_string(release >> 8 & 15) + "." +
         std::to_string(release >> 4 & 15) + std::to_string(release & 15);
}

// Adds what a probe says about itself; its caller passes only devices that can be opened.
void addDescription(const UsbDevice& device, Json& entry, std::string& text) {
  try {
    const ProbeDescription probe = describeProbe(*openUsb(device), device.name);
    Json channels = Json::array();
    for (const ProbeChannel& channel : probe.channels) {
      Json one = Json::object();
      one.set("name", channel.name).set("unit", channel.unit).set("low", channel.low);
      one.set("high", channel.high).set("step", channel.scale).set("noise", channel.noise);
      one.set("calibrated", static_cast<std::int64_t>(channel.calibrated));
      channels.push(one);
    }
    entry.set("channels", channels);
    const ProbeChannel& force = probe.channels[0];
    text += "; " + probe.name + ", " + rounded(1 / probe.period) + " Hz, force " +
            rounded(force.low) + " to " + rounded(force.high) + " N in steps of " +
            rounded(force.scale) + " N";
  } catch (const DeviceError& error) {
    text += std::string("; ") + error.what();
  }
}

void addRoundTrips(const UsbCheck& check, Json& entry, std::string& text) {
  if (check.round_trips.empty()) return;
  const Percentiles us = percentiles(check.round_trips);
  entry.set("round_trip_us", toJson(us));
  Json bins = Json::array();
  std::string spread;
  const auto counts = histogram(check.round_trips);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    bins.push(static_cast<std::int64_t>(counts[i]));
    if (counts[i] == 0) continue;
    spread += (spread.empty() ? "" : ", ") + formatCount(counts[i]);
    if (i + 1 < counts.size()) spread += " to " + rounded(kRoundTripBins[i]);
  }
  entry.set("round_trips", bins);
  text +=
      "; round trip " + rounded(us.p50) + " us, p99 " + rounded(us.p99) + " us (" + spread + ")";
}

std::string driverText(const UsbDevice& device, Json& entry) {
  if (device.haptic == kProbeName) {
    entry.set("note", "a probe: patina record --probe usb:" + device.serial);
    return "patina record --probe usb:" + device.serial;
  }
  for (const DeviceEntry& driver : deviceCatalog()) {
    if (driver.usb != device.haptic) continue;
    setLimits(driver.name, driver.limits, driver.note, entry);
    return std::string("device = ") + driver.name;
  }
  return "recognised; this version renders no force on it: a plug-in of its maker's library may";
}

// Lists haptic devices, and all others on the bus if `diagnose` is set.
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
    const bool haptic = !device.haptic.empty();
    any = any || haptic;
    if (!haptic && !diagnose) continue;
    const UsbCheck check = diagnose ? checkUsb(device) : UsbCheck{device, device.refusal};
    Json entry = Json::object();
    const std::string id = vendorProductText(device.vendor, device.product);
    entry.set("name", device.name).set("kind", "usb").set("id", id);
    entry.set("haptic", device.haptic).set("openable", device.openable);
    entry.set("state", stateText(check)).set("serial", device.serial);
    entry.set("firmware", firmwareText(device.release)).set("cable_mbit", device.megabits);
    const std::string advice =
        check.refusal ? usbAdvice(*check.refusal, device.vendor, device.product) : "";
    entry.set("advice", advice);
    std::string text = device.name;
    if (haptic) text += " (" + device.haptic + "; " + driverText(device, entry) + ")";
    const bool says_all = !advice.empty() && check.holder.empty(); // also show the state
    text += "; " + (says_all ? advice : stateText(check) + (advice.empty() ? "" : ": " + advice));
    if (diagnose) {
      text += "; release " + firmwareText(device.release);
      if (device.megabits > 0) text += "; " + rounded(device.megabits) + " Mbit/s";
      addRoundTrips(check, entry, text);
      if (device.haptic == kProbeName && !check.refusal) addDescription(device, entry, text);
    }
    list.push(entry);
    report.tell(id, text);
  }
  if (!any) report.tell("USB", "no haptic device is attached");
}

void addSerial(Json& list, Report& report) {
  for (const SerialProbe& probe : listSerialProbes()) {
    Json entry = Json::object();
    entry.set("name", probe.name).set("kind", "serial").set("openable", probe.openable);
    entry.set("state", probe.openable ? "ready" : "no permission");
    entry.set("note", "a probe: patina record --probe serial:" + probe.path);
    const std::string advice = "run 'patina devices --install-udev' as root, or join the group "
                               "dialout, and plug it in again";
    if (!probe.openable) entry.set("advice", advice);
    list.push(entry);
    report.tell(probe.path, probe.name + " (patina record --probe serial:" + probe.path + "); " +
                                (probe.openable ? "ready" : "no permission: " + advice));
  }
}

int runDevices(const DevicesOptions& options, Console& console) {
  Json list = Json::array();
  Report report(kDevicesKeys);
  if (options.install && options.diagnose)
    throw Error("devices: --install-udev and --diagnose are two calls");
  if (!options.install && !options.rules.empty())
    throw Error("devices: '" + options.rules.string() + "' is a folder for --install-udev alone");
  if (options.install) { // root loads neither a plug-in nor a device's library
    report.set("rules",
               installUdevRules(options.rules.empty() ? kUdevFolder : options.rules).string());
    report.tell("next", "run 'udevadm control --reload' as root and plug the device in again");
    return console.report(report);
  }
  addBuiltIn(list, report);
  addPlugins(list, report);
  addUsb(options.diagnose, list, report);
  addSerial(list, report);
  report.set("devices", list);
  if (options.diagnose) {
    const Latency latency = measureLatency(0.2);
    report.set("policy", latency.policy).set("realtime", latency.realtime);
    if (!latency.realtime)
      report.tell("advice", "for a steady 1 kHz allow real-time priority: add the line "
                            "'@audio - rtprio 60' to /etc/security/limits.conf, join that "
                            "group, log in again");
  }
  return console.report(report);
}

} // namespace

Command devicesCommand() {
  auto options = std::make_shared<DevicesOptions>();
  return {.name = "devices",
          .summary = "what is attached, what is wrong, what to do",
          .description =
              "Lists the built-in devices, plug-ins, and the haptic devices and probes on USB and "
              "serial lines, each with its faults and their remedies. --diagnose lists everything "
              "on the bus, with release and cable, requests each device's status 200 times to "
              "measure the round trip, identifies probes, and tries the servo's scheduling policy. "
              "Devices without access rights need a udev rule: --install-udev writes the rules of "
              "all supported devices and does nothing else.",
          .examples = {"patina devices --diagnose", "sudo patina devices --install-udev"},
          .keys = kDevicesKeys,
          .arguments = {{"--diagnose", "", "", "", "Say what is wrong and what to do.",
                         into(options->diagnose)},
                        {"--install-udev", "", "", "",
                         "Write 70-patina.rules, so that the user of this machine may open them.",
                         into(options->install)},
                        input(
                            "DIR", "Where --install-udev writes. [/etc/udev/rules.d]",
                            [options](const std::string& folder) { options->rules = folder; },
                            Times::at_most_once)},
          .run = [options](Console& console) { return runDevices(*options, console); }};
}

} // namespace patina::cli
