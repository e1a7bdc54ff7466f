#include "usb/usb_check.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <unistd.h>

#include "core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr UsbRequest kGetStatus{0x80, 0, 0, 0}; // GET_STATUS (USB 2.0, chapter 9)

// Finds the process that has the device open; other users' processes are not readable.
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
        return readSysfsLine(process.path() / "comm") + " (" + id + ")";
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
        out.refusal = got.result == UsbResult::gone ? UsbAccessError::gone : UsbAccessError::other;
      break;
    }
    out.round_trips.push_back(
        std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  }
  if (device.haptic.empty() || out.refusal) return out;
  if (const UsbResult claimed = opened.claim(0); claimed != UsbResult::ok)
    out.refusal =
        claimed == UsbResult::gone ? UsbAccessError::gone : UsbAccessError::held_by_driver;
  if (out.refusal == UsbAccessError::held_by_driver) out.holder = holderOf(device);
  return out;
}

UsbCheck checkUsb(const UsbDevice& device, int requests) {
  if (!device.openable) return {device, device.refusal.value_or(UsbAccessError::other)};
  try {
    return checkUsb(device, *openUsb(device), requests);
  } catch (const DeviceError&) {
    return {device, UsbAccessError::gone}; // unplugged after it was listed
  }
}

std::string stateText(const UsbCheck& check) {
  if (!check.refusal) return "ready";
  switch (*check.refusal) {
  case UsbAccessError::permission:
    return "no permission";
  case UsbAccessError::held_by_driver:
    return "in use by " + (check.holder.empty() ? "a driver or another program" : check.holder);
  case UsbAccessError::gone:
    return "is gone";
  case UsbAccessError::other:
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
    // The link leads to the USB interface or a port below it; the device is a parent.
    fs::path above = fs::canonical(item->path() / "device", none);
    std::string name;
    for (int i = 0; i < 3 && name.empty() && !none; ++i, above = above.parent_path())
      name = readSysfsLine(above / "product");
    if (!name.starts_with(kProbeName)) continue;
    const std::string path = dev + "/" + port;
    list.push_back({path, name, ::access(path.c_str(), R_OK | W_OK) == 0});
  }
  std::ranges::sort(list, {}, &SerialProbe::path);
  return list;
}

} // namespace patina
