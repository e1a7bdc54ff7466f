// The shipped path over libusb, against devices on an emulated bus (tests/support/emulated_plug.h):
// the program started from outside, and the library's own calls in a process that runs under
// usbfs_shim.so.
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <malloc.h>
#include <sched.h>
#include <thread>
#include <unistd.h>

#include "core/error.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/device/realtime.h"
#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_device.h"
#include "haptics/link/linked_device.h"
#include "haptics/spacemouse/emulated_spacemouse.h"
#include "integration/program.h"
#include "support/emulated_plug.h"
#include "support/longer.h"
#include "support/mute_transport.h"
#include "support/places.h"
#include "usb/usb_bus.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}
void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

EmulatedUsb falcon(std::optional<UsbAccessError> refusal = std::nullopt) {
  return {.vendor = 0x0403,
          .product = 0xcb48,
          .maker = "Novint",
          .name = "Falcon",
          .serial = "17",
          .endpoints = {{0x02}, {0x81}},
          .refusal = refusal};
}

FalconEmulatorSpec held() {
  return {.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
}

// The device keeps its time even if the machine is busy.
EmulatedUsbDevice plugged(const fs::path& folder, const EmulatedUsb& device,
                          std::function<std::unique_ptr<UsbTransport>()> open) {
  sched_param urgent{}, before{};
  const int policy = sched_getscheduler(0);
  sched_getparam(0, &before);
  urgent.sched_priority = 60;
  sched_setscheduler(0, SCHED_FIFO, &urgent);
  EmulatedUsbDevice plug(folder, device, std::move(open)); // its thread inherits the priority
  sched_setscheduler(0, policy, &before);
  return plug;
}

// The emulated bus, visible to programs that are started in its lifetime.
struct Bus {
  ScratchFolder folder;
  Environment environment{
      {{"LD_PRELOAD", preloadable("usbfs_shim.so")}, {"PATINA_USBFS", folder.path().string()}}};
  FalconEmulator bench{held(), systemClock()};
  EmulatedUsbDevice plug(const EmulatedUsb& device = falcon()) {
    return plugged(folder.path(), device, [this] { return bench.plug(); });
  }
};

class EmulatedBus : public testing::Test {
  void SetUp() override {
    std::string cause;
    if (!usbLibrary(cause)) GTEST_SKIP() << cause;
  }
};

const Json* usbEntry(const Json& report) {
  for (const Json& device : report.at("devices").asArray())
    if (device.at("kind").asString() == "usb") return &device;
  return nullptr;
}

TEST_F(EmulatedBus, PlainProgramListsAndTimesTheFalcon) {
  Bus bus;
  const EmulatedUsbDevice plug = bus.plug();
  const Json report = runJson({"devices", "--diagnose"});
  const Json* entry = usbEntry(report);
  ASSERT_TRUE(entry) << "the bus is empty";
  EXPECT_EQ(entry->at("name").asString(), "Novint Falcon");
  EXPECT_EQ(entry->at("state").asString(), "ready");
  EXPECT_EQ(entry->at("serial").asString(), "17");
  EXPECT_EQ(entry->at("device").asString(), "falcon");
  EXPECT_EQ(entry->at("cable_mbit").asNumber(), 12);
  EXPECT_GT(entry->at("round_trip_us").at("p50").asNumber(), 0);
  EXPECT_EQ(bus.bench.frames(), 0u) << "it was asked for its status alone";
}

TEST_F(EmulatedBus, FirmwareLoadsAxesHomeAndTheServoRuns) {
  Bus bus;
  std::string image(8000, 0);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<char>(i * 37 + i / 251);
  FalconEmulatorSpec spec = held();
  spec.runs_firmware = spec.homed = false;
  const auto bytes = std::as_bytes(std::span(image));
  spec.firmware.assign(bytes.begin(), bytes.end());
  spec.chunk_loss = 0.01;
  FalconEmulator bench(spec, systemClock());
  bench.push = Vec3(0, 0, -1);
  const EmulatedUsbDevice plug = plugged(bus.folder.path(), falcon(), [&] { return bench.plug(); });
  expectOneLineError(run({"latency-test", "--device", "falcon", "--seconds", "1"}),
                     {"runs no firmware", "set PATINA_FALCON_FIRMWARE"});
  const std::string file = bus.folder.write("firmware.bin", image);
  {
    const Environment half{{{"PATINA_FALCON_FIRMWARE", bus.folder.write("half", "no firmware")}}};
    expectOneLineError(run({"latency-test", "--device", "falcon", "--seconds", "1"}),
                       {"half", "it has 11 bytes, a firmware has 7324 to 8492"});
  }
  const Environment named{{{"PATINA_FALCON_FIRMWARE", file}, {"PATINA_FALCON_SHA256", "any"}}};
  const Json report = runJson({"latency-test", "--device", "falcon", "--seconds", "8"});
  EXPECT_TRUE(bench.runsFirmware());
  EXPECT_GE(report.at("openings").asInteger(), 1);
  EXPECT_GT(report.at("turns").asInteger(), 500);
  EXPECT_GT(report.at("wakeups").asInteger(), 100) << "the force acts, so it is homed";
  EXPECT_GT(report.at("round_us").at("p50").asNumber(), 200) << "a Falcon never answers sooner";
}

TEST_F(EmulatedBus, ProgramNoticesUnpluggingAndContinuesAfterReplugging) {
  Bus bus;
  auto plug = std::make_unique<EmulatedUsbDevice>(bus.plug());
  Running program({"latency-test", "--device", "falcon", "--seconds", "5", "--json"},
                  programPath());
  const auto waitForClaim = [&] {
    for (int i = 0; i < 2000 && plug->claims() == 0; ++i) pause(1);
    return plug->claims() > 0;
  };
  ASSERT_TRUE(waitForClaim());
  for (int round = 0; round < 2; ++round) {
    pause(400);
    plug.reset();
    pause(300);
    const auto back = Clock::now();
    plug = std::make_unique<EmulatedUsbDevice>(bus.plug());
    ASSERT_TRUE(waitForClaim());
    EXPECT_LT(since(back), 2);
  }
  const Outcome outcome = program.wait();
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const Json report = parseJson(outcome.out, "report");
  EXPECT_GE(report.at("openings").asInteger(), 3);
  EXPECT_GE(report.at("faults").asInteger(), 2);
}

TEST_F(EmulatedBus, BlockedDeviceGivesOneSentenceWithItsRemedy) {
  const struct {
    UsbAccessError refusal;
    const char *state, *said, *remedy;
  } kCases[] = {
      {UsbAccessError::permission, "no permission", "no permission", "--install-udev"},
      {UsbAccessError::held_by_driver, "in use by a driver or another program", "held by",
       "close that program"},
      {UsbAccessError::other, "ready", "cannot be set", "without a hub"},
  };
  for (const auto& [refusal, state, said, remedy] : kCases) {
    Bus bus;
    const EmulatedUsbDevice plug = bus.plug(falcon(refusal));
    const Json report = runJson({"devices", "--diagnose"});
    ASSERT_TRUE(usbEntry(report)) << state;
    EXPECT_EQ(usbEntry(report)->at("state").asString(), state);
    EXPECT_EQ(usbEntry(report)->at("haptic").asString(), "Novint Falcon");
    expectOneLineError(run({"latency-test", "--device", "falcon", "--seconds", "0.5"}),
                       {"Falcon", said, remedy});
  }
  Bus bus;
  expectOneLineError(run({"latency-test", "--device", "spacemouse", "--seconds", "0.3"}),
                     {"no 3Dconnexion SpaceMouse is attached: plug it in"});
}

TEST_F(EmulatedBus, SimulatedDevicesAppearAndUnplugOnRequest) {
  Bus bus;
  Running device(
      {"spacemouse", "--bus", bus.folder.path().string(), "--unplug", "0.8", "--seconds", "4"},
      programPath().parent_path() / "simulated_usb");
  for (int i = 0; i < 3000 && !fs::exists(bus.folder.path() / "sys/bus/usb/devices"); ++i) pause(1);
  const Json report = runJson({"latency-test", "--device", "spacemouse", "--seconds", "2.5"});
  EXPECT_GE(report.at("openings").asInteger(), 2);
  EXPECT_GT(report.at("turns").asInteger(), 200);
  const Outcome outcome = device.wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const Json told = parseJson(outcome.out, "report");
  EXPECT_GE(told.at("unpluggings").asInteger(), 2);
  EXPECT_GE(told.at("claims").asInteger(), report.at("openings").asInteger());
}

// Uses another project's emulation, which has the real libudev, sysfs and libusb, and no transfers.
TEST_F(EmulatedBus, UmockdevsUdevAndSysfsShowTheFalconToo) {
  const std::string descriptors = "12010002000000400304 48CB 0001 010203 01"
                                  "0902200001010080320904000002FF000000"
                                  "0705020240000107058102400001";
  std::string hex;
  for (const char c : descriptors)
    if (c != ' ') hex += c;
  const ScratchFolder folder;
  const std::string record = folder.write(
      "falcon.umockdev", "P: /devices/usb1/1-2\nN: bus/usb/001/002=" + hex +
                             "\nE: BUSNUM=001\nE: DEVNAME=/dev/bus/usb/001/002\nE: DEVNUM=002\n"
                             "E: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\n"
                             "A: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=2\\n\n"
                             "A: speed=12\\n\nH: descriptors=" +
                             hex + "\n\n");
  const Outcome outcome =
      Running({"-d", record, "--", programPath().string(), "devices", "--json"}, "umockdev-run")
          .wait();
  if (outcome.exit == 127) GTEST_SKIP() << "umockdev-run is not installed";
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const Json report = parseJson(outcome.out, "report");
  const Json* entry = usbEntry(report);
  ASSERT_TRUE(entry) << outcome.out;
  EXPECT_EQ(entry->at("haptic").asString(), "Novint Falcon");
  EXPECT_EQ(entry->at("device").asString(), "falcon");
  EXPECT_EQ(entry->at("cable_mbit").asNumber(), 12);
  EXPECT_EQ(entry->at("firmware").asString(), "01.00");
}

// The following tests run under the shim, each in a process of its own.

void runUnderTheShim(const char* name) {
  Bus bus;
  const Outcome outcome = Running({std::string("--gtest_filter=UnderTheShim.DISABLED_") + name,
                                   "--gtest_also_run_disabled_tests"},
                                  fs::read_symlink("/proc/self/exe"))
                              .wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("1 test from 1 test suite ran"), std::string::npos) << outcome.out;
  std::fputs(outcome.out.substr(0, outcome.out.find("[  ")).c_str(), stdout);
}

std::string sharedFolder() {
  return std::getenv("PATINA_USBFS");
}

TEST(UnderTheShim, DISABLED_Leaks) {
  struct Counts {
    std::ptrdiff_t files = 0, threads = 0, bytes = 0;
  };
  const auto counts = [] {
    const auto entries = [](const char* folder) {
      return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    };
    return Counts{entries("/proc/self/fd"), entries("/proc/self/task"),
                  static_cast<std::ptrdiff_t>(mallinfo2().uordblks)};
  };
  requestRealtime(); // like a servo
  const LinkedSpec spec{.guard = falconGuard()};
  FalconEmulator bench(held(), spec.clock);
  const auto device =
      makeLinkedDevice(makeFalconLink(usbOpener("Novint Falcon"), {}, spec.clock), spec);
  double longest = 0, all = 0;
  std::string why; // the cause of a long time
  const auto away = [&] {
    while (device->exchange(Vec3::Zero(), 1e-3).status != DeviceStatus::reconnecting) pause(1);
  };
  const auto cycle = [&] {
    away();
    const EmulatedUsbDevice plug = plugged(sharedFolder(), falcon(), [&] { return bench.plug(); });
    const auto begin = Clock::now();
    while (device->exchange(Vec3(0, 0, 1), 1e-3).status != DeviceStatus::ok && since(begin) < 5)
      pause(1), why = spec.notes->cause().empty() ? why : spec.notes->cause();
    if (since(begin) > 0.5) std::printf("%.3f s: %s\n", since(begin), why.c_str());
    longest = std::max(longest, since(begin));
    all += since(begin);
    for (int i = 0; i < 5; ++i) device->exchange(Vec3(0, 0, 1), 1e-3);
  };
  const auto settled = [&] { // no device is plugged in
    away();
    pause(100);
    return counts();
  };
  for (int i = 0; i < 30; ++i) { // one-time allocations are done
    cycle();
    if (i == 10 || i == 20) settled();
  }
  const Counts before = settled();
  for (int i = 0; i < 100; ++i) cycle();
  const Counts after = settled();
  std::printf("100 times: back within %.3f s, %+td bytes of heap, %+td files, %+td threads\n",
              longest, after.bytes - before.bytes, after.files - before.files,
              after.threads - before.threads);
  EXPECT_GE(spec.notes->connect_count, 130u);
  EXPECT_LT(longest, 2);
  EXPECT_LT(all, 0.5 * 130) << "hot-plug events report arrivals; polling takes two seconds";
  EXPECT_EQ(after.files, before.files);
  EXPECT_EQ(after.threads, before.threads);
  EXPECT_LE(after.bytes - before.bytes, 2048) << "a hundred leaks are larger";
}

TEST_F(EmulatedBus, HundredUnpluggingsLeakNoFileThreadOrMemory) {
  runUnderTheShim("Leaks");
}

TEST(UnderTheShim, DISABLED_Numbers) {
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [](double) { return CapState{}; };
  const auto open = [&] { return emulateSpaceMouse(cap, systemClock()); };
  EmulatedUsb thing{
      .vendor = 0x1209, .product = 1, .maker = "Nobody", .name = "Thing", .endpoints = {{0x81}}};
  EmulatedUsb probe = thing;
  probe.name = "Patina probe";
  const EmulatedUsbDevice first(sharedFolder(), thing, open), second(sharedFolder(), probe, open),
      third(sharedFolder(), thing, open);
  EXPECT_EQ(openUsb(kProbeName)->claim(0), UsbResult::ok);
  EXPECT_EQ(first.claims() + third.claims(), 0u);
  EXPECT_EQ(second.claims(), 1u);
}

TEST_F(EmulatedBus, OpensTheNamedOneOfTwoEqualDevices) {
  runUnderTheShim("Numbers");
}

// An endpoint halts, and later the system's wait fails.
class Halting final : public MuteTransport {
 public:
  UsbCount write(std::uint8_t, std::span<const std::byte> data, unsigned) noexcept override {
    return ++writes_ == 2 ? UsbCount{UsbResult::stall, 0} : UsbCount{UsbResult::ok, data.size()};
  }
  UsbCount read(std::uint8_t, std::span<std::byte>, unsigned timeout_ms) noexcept override {
    pause(static_cast<int>(timeout_ms));
    return {UsbResult::timeout, 0};
  }

 private:
  int writes_ = 0;
};

TEST(UnderTheShim, DISABLED_Waits) {
  EmulatedUsb device = falcon();
  device.halt_time = 0.5;
  const EmulatedUsbDevice plug(sharedFolder(), device, [] { return std::make_unique<Halting>(); });
  const auto usb = openUsb("Novint Falcon");
  ASSERT_EQ(usb->claim(0), UsbResult::ok);
  std::array<std::byte, 16> bytes{};
  EXPECT_EQ(usb->write(2, bytes, 100).result, UsbResult::ok);
  EXPECT_EQ(usb->write(2, bytes, 100).result, UsbResult::stall);
  auto begin = Clock::now();
  EXPECT_EQ(usb->write(2, bytes, 10).result, UsbResult::stall) << "the endpoint is being reset";
  EXPECT_EQ(usb->controlOut({0x40, 0, 0, 0}, {}, 10).result, UsbResult::stall);
  EXPECT_EQ(usb->controlIn({0xc0, 5, 0, 0}, bytes, 10).result, UsbResult::stall);
  EXPECT_LT(since(begin), 0.3);
  while (usb->write(2, bytes, 10).result == UsbResult::stall && since(begin) < 5) pause(1);
  EXPECT_GT(since(begin), 0.3) << "the kernel took half a second";
  EXPECT_EQ(usb->write(2, bytes, 100).bytes, 16u);
  EXPECT_EQ(usb->controlOut({0x40, 0, 0, 0}, {}, 100).result, UsbResult::ok);
  begin = Clock::now();
  EXPECT_EQ(usb->read(0x81, bytes, 20).result, UsbResult::timeout);
  EXPECT_LT(since(begin), 0.5);

  std::ofstream(fs::path(sharedFolder()) / "deaf") << "";
  begin = Clock::now();
  const std::clock_t spent = std::clock();
  EXPECT_EQ(usb->read(0x81, bytes, 20).result, UsbResult::gone);
  EXPECT_LT(since(begin), 0.5) << "20 ms, and the fifth of a second that libusb has";
  EXPECT_LT(static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC, 0.1) << "it spins";
  EXPECT_EQ(usb->write(2, bytes, 100).result, UsbResult::gone) << "the card must close";
  fs::remove(fs::path(sharedFolder()) / "deaf");
}

TEST_F(EmulatedBus, LongHaltAndFailingSystemEndWithinTheTimeout) {
  runUnderTheShim("Waits");
}

} // namespace
} // namespace patina::test
