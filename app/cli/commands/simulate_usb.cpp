// A Falcon or a SpaceMouse on a bus that is a folder.
#include <cmath>
#include <cstdlib>
#include <thread>
#include <unistd.h>

#include "app/cli/commands/simulated_devices.h"
#include "core/error.h"
#include "core/file.h"
#include "haptics/devices/falcon/emulated_falcon.h"
#include "haptics/devices/falcon/falcon_line.h"
#include "haptics/devices/spacemouse/emulated_spacemouse.h"
#include "haptics/servo/realtime.h"
#include "usb/emulated_plug.h"

namespace patina::cli {

namespace {

// Whom its folder outlives only where it was given one.
struct Bus {
  explicit Bus(const std::filesystem::path& given) : folder(given) {
    if (!given.empty()) return;
    std::string made = std::filesystem::temp_directory_path() / "patina-usb-XXXXXX";
    if (!::mkdtemp(made.data())) throw FileError(made, 0, "cannot be made");
    folder = own = made;
  }
  ~Bus() {
    std::error_code ignored;
    if (!own.empty()) std::filesystem::remove_all(own, ignored);
  }
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  std::filesystem::path folder, own;
};

// A hand that draws circles, through the middle of the workspace and out of it upwards.
Vec3 circle(double t) {
  return 0.015 * Vec3(std::cos(3 * t), std::sin(3 * t), 0.5 * std::sin(2 * t) - 0.3);
}

std::vector<std::byte> imageOf(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const std::string text = readFile(file);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

} // namespace

void simulateUsb(const SimulatedUsbSpec& spec, const std::optional<double>& seconds,
                 Console& console, Report& report) {
  const auto clock = systemClock();
  const Bus bus(spec.bus);
  FalconBenchSpec made{.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
  made.firmware = imageOf(spec.firmware);
  made.runs_firmware = spec.firmware.empty();
  FalconBench bench(made, clock);
  bench.on_frame = [&](double t, const std::array<int, 3>&) { bench.rest = circle(t); };
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [](double t) {
    CapState state;
    state.shift = (300 * Vec3(std::sin(t), 0, std::cos(t))).array().round();
    state.turn = Vec3(0, std::round(100 * std::sin(0.5 * t)), 0);
    return state;
  };
  EmulatedUsb device{.vendor = kFalconVendor,
                     .product = kFalconProduct,
                     .maker = "Novint",
                     .name = "Falcon",
                     .serial = "EMULATED",
                     .endpoints = {{0x02}, {0x81}}};
  if (spec.cap)
    device = {.vendor = 0x256f,
              .product = 0xc635,
              .maker = "3Dconnexion",
              .name = "SpaceMouse Compact",
              .interface_class = 3,
              .endpoints = {{0x81, true}}};
  device.refusal = spec.refusal;
  const auto open = [&]() -> std::unique_ptr<UsbTransport> {
    if (spec.cap) return emulateSpaceMouse(cap, clock);
    return bench.plug();
  };
  requestRealtime(); // which the plug's thread has from this one
  console.say("it is seen by what runs with PATINA_USBFS=" + bus.folder.string() +
              " and LD_PRELOAD=usbfs_shim.so, which the tests' build puts beside this program");
  std::size_t claims = 0;
  int unpluggings = 0;
  const double begin = clock->now();
  const auto over = [&] {
    return console.progress().cancelled() || (seconds && clock->now() - begin >= *seconds);
  };
  while (!over()) {
    {
      EmulatedPlug plug(bus.folder, device, open);
      const double since = clock->now();
      while (!over() && !(spec.unplug && clock->now() - since >= *spec.unplug))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      claims += plug.claims();
    }
    if (over()) break;
    ++unpluggings;
    for (int i = 0; i < 50 && !over(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  report.set("bus", bus.folder.string()).set("seconds", clock->now() - begin);
  report.set("claims", claims).set("unpluggings", unpluggings);
  if (!spec.cap) report.set("frames", static_cast<std::int64_t>(bench.frames()));
}

} // namespace patina::cli
