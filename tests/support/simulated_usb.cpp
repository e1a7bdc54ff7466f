// Simulates a Falcon or a SpaceMouse on an emulated bus, which is a folder. A hand draws circles
// with the Falcon's handle, or sways the SpaceMouse's cap. It ends with Ctrl-C or after --seconds,
// and then prints its counts as JSON.
//   simulated_usb falcon|spacemouse --bus DIR [--seconds S] [--unplug S] [--firmware FILE]
//                 [--refuse permission|claim|transfers]
// --unplug pulls it out for half a second after each S; --firmware is what a Falcon's boot loader
// takes; --refuse fails to be opened, claimed (another program has it), or at every transfer.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "core/file.h"
#include "core/json.h"
#include "haptics/device/realtime.h"
#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_line.h"
#include "haptics/spacemouse/emulated_spacemouse.h"
#include "support/emulated_plug.h"

namespace patina::test {
namespace {

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  bool cap = false; // a SpaceMouse, otherwise a Falcon
  std::filesystem::path bus, firmware;
  double seconds = 1e9, unplug = 1e9; // [s]
  std::optional<UsbAccessError> refusal;
};

Options parse(int argc, char** argv) {
  Options options;
  const std::string device = argc > 1 ? argv[1] : "";
  if (device != "falcon" && device != "spacemouse")
    throw std::invalid_argument("name a device: falcon or spacemouse");
  options.cap = device == "spacemouse";
  for (int i = 2; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(key + " needs a value");
    const std::string value = argv[i + 1];
    if (key == "--bus")
      options.bus = value;
    else if (key == "--seconds")
      options.seconds = std::stod(value);
    else if (key == "--unplug")
      options.unplug = std::stod(value);
    else if (key == "--firmware")
      options.firmware = value;
    else if (key == "--refuse")
      options.refusal = value == "permission" ? UsbAccessError::permission
                        : value == "claim"    ? UsbAccessError::held_by_driver
                                              : UsbAccessError::other;
    else
      throw std::invalid_argument("unknown option " + key);
  }
  if (options.bus.empty()) throw std::invalid_argument("--bus names the folder of the bus");
  return options;
}

// A hand that draws circles through the middle of the workspace and out of it at the top.
Vec3 circle(double t) {
  return 0.015 * Vec3(std::cos(3 * t), std::sin(3 * t), 0.5 * std::sin(2 * t) - 0.3);
}

std::vector<std::byte> imageOf(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const std::string text = readFile(file);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

void run(const Options& options) {
  const auto clock = systemClock();
  FalconEmulatorSpec made{.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
  made.firmware = imageOf(options.firmware);
  made.runs_firmware = options.firmware.empty();
  FalconEmulator bench(made, clock);
  bench.on_frame = [&](double t, const std::array<int, 3>&) { bench.rest = circle(t); };
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [](double t) {
    CapState state;
    state.translation = (300 * Vec3(std::sin(t), 0, std::cos(t))).array().round();
    state.rotation = Vec3(0, std::round(100 * std::sin(0.5 * t)), 0);
    return state;
  };
  EmulatedUsb device{.vendor = kFalconVendor,
                     .product = kFalconProduct,
                     .maker = "Novint",
                     .name = "Falcon",
                     .serial = "EMULATED",
                     .endpoints = {{0x02}, {0x81}}};
  if (options.cap)
    device = {.vendor = 0x256f,
              .product = 0xc635,
              .maker = "3Dconnexion",
              .name = "SpaceMouse Compact",
              .interface_class = 3,
              .endpoints = {{0x81, true}}};
  device.refusal = options.refusal;
  const auto open = [&]() -> std::unique_ptr<UsbTransport> {
    if (options.cap) return emulateSpaceMouse(cap, clock);
    return bench.plug();
  };
  requestRealtime(); // the emulated device's thread inherits it
  std::size_t claims = 0;
  int unpluggings = 0;
  const double begin = clock->now();
  const auto over = [&] { return interrupted || clock->now() - begin >= options.seconds; };
  while (!over()) {
    {
      EmulatedUsbDevice plug(options.bus, device, open);
      const double since = clock->now();
      while (!over() && clock->now() - since < options.unplug)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      claims += plug.claims();
    }
    if (over()) break;
    ++unpluggings;
    for (int i = 0; i < 50 && !over(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  Json counts = Json::object();
  counts.set("claims", claims).set("unpluggings", unpluggings).set("frames", bench.frames());
  std::puts(counts.dump().c_str());
}

} // namespace
} // namespace patina::test

int main(int argc, char** argv) {
  for (const int number : {SIGINT, SIGTERM})
    std::signal(number, [](int) { patina::test::interrupted = 1; });
  try {
    patina::test::run(patina::test::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
