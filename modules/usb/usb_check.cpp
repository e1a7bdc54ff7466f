#include "usb/usb_check.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <unistd.h>

#include "core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr UsbRequest kGetStatus{0x80, 0, 0, 0}; // of the standard, chapter 9

// Another program's open device; its own user's, for others may not be looked at.
std::string holderOf(const UsbDevice& device) {
  char node[64];
  std::snprintf(node, sizeof node, "/dev/bus/usb/%03d/%03d", device.bus, device.address);
  std::error_code code;
  const std::string self = std::to_string(::getpid());
  for (const auto& process : fs::directory_iterator("/proc", code)) {
    const std::string id = process.path().filename();
    if (id == self || !std::ranges::all_of(id, [](char c) { return c >= '0' && c <= '9'; }))
      continue;
    std::error_code denied;
    for (fs::directory_iterator item(process.path() / "fd", denied), end; !denied && item != end;
         item.increment(denied))
      if (std::error_code none; fs::read_symlink(item->path(), none) == node)
        return kernelLine(process.path() / "comm") + " (" + id + ")";
  }
  return {};
}

} // namespace

UsbCheck checkUsb(const UsbDevice& device, UsbTransport& opened, int requests) {
  UsbCheck out{device, device.refusal};
  using Clock = std::chrono::steady_clock;
  for (int i = 0; i < requests; ++i) {
    std::array<std::byte, 2> status;
    const auto begin = Clock::now();
    const UsbCount got = opened.controlIn(kGetStatus, status, 100);
    if (got.result != UsbResult::ok) {
      if (!out.refusal)
        out.refusal = got.result == UsbResult::gone ? UsbRefusal::gone : UsbRefusal::other;
      break;
    }
    out.round_trips.push_back(
        std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  }
  if (device.haptic.empty() || out.refusal) return out;
  if (const UsbResult claimed = opened.claim(0); claimed != UsbResult::ok)
    out.refusal = claimed == UsbResult::gone ? UsbRefusal::gone : UsbRefusal::held_by_driver;
  if (out.refusal == UsbRefusal::held_by_driver) out.holder = holderOf(device);
  return out;
}

UsbCheck checkUsb(const UsbDevice& device, int requests) {
  if (!device.openable) return {device, device.refusal.value_or(UsbRefusal::other)};
  try {
    return checkUsb(device, *openUsb(device), requests);
  } catch (const DeviceError&) {
    return {device, UsbRefusal::gone}; // it was there a moment ago
  }
}

std::string stateText(const UsbCheck& check) {
  if (!check.refusal) return "ready";
  switch (*check.refusal) {
  case UsbRefusal::permission:
    return "no permission";
  case UsbRefusal::held_by_driver:
    return "in use by " + (check.holder.empty() ? "a driver or another program" : check.holder);
  case UsbRefusal::gone:
    return "is gone";
  case UsbRefusal::other:
    break;
  }
  return "does not answer";
}

std::array<std::size_t, 8> histogram(const std::vector<double>& round_trips) {
  std::array<std::size_t, 8> counts{};
  for (const double us : round_trips)
    ++counts[static_cast<std::size_t>(std::ranges::lower_bound(kRoundTripBins, us) -
                                      kRoundTripBins.begin())];
  return counts;
}

std::vector<SerialProbe> listSerialProbes(const std::string& sys, const std::string& dev) {
  std::vector<SerialProbe> list;
  std::error_code code;
  for (fs::directory_iterator item(sys, code), end; !code && item != end; item.increment(code)) {
    const std::string port = item->path().filename();
    if (!port.starts_with("ttyACM") && !port.starts_with("ttyUSB")) continue;
    std::error_code none;
    // The interface, for some drivers a port below it; above it the device.
    fs::path above = fs::canonical(item->path() / "device", none);
    std::string name;
    for (int i = 0; i < 3 && name.empty() && !none; ++i, above = above.parent_path())
      name = kernelLine(above / "product");
    if (!name.starts_with(kProbeName)) continue;
    const std::string path = dev + "/" + port;
    list.push_back({path, name, ::access(path.c_str(), R_OK | W_OK) == 0});
  }
  std::ranges::sort(list, {}, &SerialProbe::path);
  return list;
}

} // namespace patina
