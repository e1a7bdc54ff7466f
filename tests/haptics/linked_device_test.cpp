// A device with a thread of its own, in real time over the emulated wire.
#include "haptics/link/linked_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "core/error.h"
#include "haptics/falcon_support.h"
#include "haptics/simulation/wire_benchmark.h"
#include "support/longer.h"
#include "support/sanitized.h"

namespace patina::test {
namespace {

void waitFor(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// Other programs can only make a run worse: one undisturbed run of twelve is enough.
TEST(EmulatedWire, IsAsSteadyAsABareTimerAndNeverRendersAnOldPosition) {
  constexpr double kMost = 100; // us
  double late = 1e9, round = 1e9;
  for (int i = 0; i < (kSanitized ? 1 : 12) && (late > kMost || round > kMost); ++i) {
    Progress progress;
    const WireBenchmark run = runOnEmulatedWire({.seconds = 0.1 * longer(50)}, progress);
    EXPECT_EQ(run.outdated_states, 0U) << run.max_error;
    EXPECT_EQ(run.uncounted, 0U) << "an uncounted overrun";
    EXPECT_GT(run.round_trips, run.ticks / 2);
    EXPECT_NEAR(static_cast<double>(run.ticks + run.missed), 100. * longer(50), 150);
    late = std::min(late, run.late_us.p999 - run.bare_late_us.p999);
    round = std::min(round, run.round_us.p999 - run.bare_round_us.p999);
    std::printf("p99.9: late %.0f us, bare %.0f us; round trip %.0f us, bare %.0f us; missed %zu\n",
                run.late_us.p999, run.bare_late_us.p999, run.round_us.p999, run.bare_round_us.p999,
                static_cast<std::size_t>(run.missed));
  }
  if (kSanitized) return;
  EXPECT_LE(late, kMost);
  EXPECT_LE(round, kMost);
}

TEST(EmulatedWire, DetectsAllFaultyFramesAndRendersNone) {
  Progress progress;
  // A machine that holds up several threads at once may spoil a row that no delay explains.
  std::uint64_t unexplained = 1;
  for (int i = 0; i < 3 && unexplained > 0; ++i) {
    const WireBenchmark run =
        runOnEmulatedWire({.seconds = 3, .faults_per_thousand = 20}, progress);
    EXPECT_GT(run.injected, 5U);
    EXPECT_EQ(run.undetected_faults, 0U);
    EXPECT_EQ(run.outdated_states, 0U) << run.max_error;
    EXPECT_EQ(run.causes.injected + run.causes.delayed + run.causes.unexplained, run.faults);
    unexplained = run.causes.unexplained;
  }
  EXPECT_EQ(unexplained, 0U);
}

TEST(EmulatedWire, TellsFaultsByTheMachinesLoadFromInjectedOnes) {
  Progress progress;
  const WireBenchmark run = runOnEmulatedWire({.seconds = 3, .load = 4}, progress);
  EXPECT_EQ(run.injected + run.causes.injected + run.causes.unexplained, 0U);
  EXPECT_EQ(run.causes.delayed, run.faults);
}

TEST(FaultTally, CountsARowOfFaultsForWhatBeganIt) {
  FaultTally tally;
  double t = 0;
  const auto add = [&](bool injected, bool faulty, double took = 3e-4, double pause = 7e-4) {
    tally.add({t, t + took, injected, faulty});
    t += took + pause;
  };
  const auto expect = [&](std::uint64_t injected, std::uint64_t delayed,
                          std::uint64_t unexplained) {
    add(false, false); // the last one is not counted yet
    EXPECT_EQ(tally.causes().injected, injected);
    EXPECT_EQ(tally.causes().delayed, delayed);
    EXPECT_EQ(tally.causes().unexplained, unexplained);
  };
  expect(0, 0, 0);
  for (const bool injected : {true, false, false}) add(injected, true, 2e-3);
  expect(3, 0, 0);
  add(false, true, 2e-3); // its reply came too late
  add(false, true);
  add(true, true, 2e-3); // a fault is injected before the line is quiet
  expect(4, 2, 0);
  add(false, false, 3e-4, 5e-3); // the thread did not run
  add(false, true);
  expect(4, 3, 0);
  add(false, true);
  add(false, true, 2e-3);
  expect(4, 3, 2);
  add(false, true);
  tally.dropLast();
  expect(4, 3, 2);
  add(true, false, 2e-3); // its second answer comes with the next exchange
  add(false, true);
  expect(5, 3, 2);
}

TEST(EmulatedWire, RefusesInvalidRuns) {
  Progress progress;
  EXPECT_THROW(runOnEmulatedWire({.seconds = 0}, progress), std::invalid_argument);
  EXPECT_THROW(runOnEmulatedWire({.load = -1}, progress), std::invalid_argument);
}

// Bench and link run in their own thread; the test's thread reads the wire's record.
struct Wire {
  Wire()
      : bench({.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}}, spec.clock) {
    spec.guard = falconGuard();
    spec.guard.max_command_age = 0.1; // the test's thread has no real-time priority
    bench.on_frame = [this](double, const std::array<int, 3>& motors) {
      pushes = motors != std::array<int, 3>{};
      frames = frames + 1;
    };
    device =
        makeLinkedDevice(makeFalconLink([this] { return bench.plug(); }, {}, spec.clock), spec);
  }
  ~Wire() { device.reset(); }
  // Ticks until the guard passes the full force.
  bool feel(const Vec3& force) {
    for (int i = 0; i < 5000; ++i) {
      device->exchange(force, 1e-3);
      if (spec.notes->gain >= 1 && pushes) return true;
      waitFor(1);
    }
    return false;
  }
  LinkedSpec spec;
  std::atomic<bool> pushes{false};
  std::atomic<int> frames{0};
  FalconEmulator bench;
  std::unique_ptr<Device> device;
};

TEST(LinkedDevice, LeavesNoForceAtTheWireIfTheServoStops) {
  Wire wire;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(wire.feel(Vec3(0, 0, 1)));
    const int before = wire.frames;
    waitFor(400); // no exchange
    EXPECT_FALSE(wire.pushes);
    EXPECT_GT(wire.frames, before + 10) << "frames without force are still sent";
    EXPECT_EQ(wire.spec.notes->inhibit, ForceInhibit::servo);
  }
}

TEST(LinkedDevice, LeavesNoForceAndTakesNoTimeOnClose) {
  Wire wire;
  ASSERT_TRUE(wire.feel(Vec3(0, 1, 0)));
  const double begin = wire.spec.clock->now();
  wire.device.reset();
  EXPECT_LT(wire.spec.clock->now() - begin, 1);
  EXPECT_FALSE(wire.pushes);
}

TEST(LinkedDevice, IsDisconnectedWithACauseUntilConnected) {
  Wire wire;
  ASSERT_TRUE(wire.feel(Vec3(1, 0, 0)));
  EXPECT_EQ(inhibitText(*wire.spec.notes), "");
  wire.device.reset();
  wire.bench.unplug();
  wire.device = makeLinkedDevice(
      makeFalconLink([&] { return wire.bench.plug(); }, {}, wire.spec.clock), wire.spec);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(wire.device->exchange(Vec3(1, 0, 0), 1e-3).status, DeviceStatus::reconnecting);
    waitFor(1);
  }
  EXPECT_EQ(inhibitText(*wire.spec.notes), "no force: the emulated Falcon is not attached");
}

// A link whose exchange() blocks its caller for `wait` milliseconds.
class SlowLink final : public DeviceLink {
 public:
  Opening open() noexcept override { return {true, {}}; }
  DeviceState exchange(const Vec3&) noexcept override {
    waitFor(wait);
    return {};
  }
  static inline std::atomic<int> wait{0};
};

TEST(LinkedDevice, NeverBlocksTheServoLongerThanItsLimit) {
  const LinkedSpec spec{.reply_timeout = 0.5e-3};
  const auto device = makeLinkedDevice(std::make_unique<SlowLink>(), spec);
  SlowLink::wait = 0;
  while (device->exchange(Vec3::Zero(), 1e-3).status != DeviceStatus::ok) waitFor(1);
  SlowLink::wait = 200;
  double least = 1;
  bool away = false;
  for (int i = 0; i < 100; ++i) {
    const double begin = spec.clock->now();
    away = device->exchange(Vec3::Zero(), 1e-3).status == DeviceStatus::reconnecting || away;
    least = std::min(least, std::max(spec.clock->now() - begin, 0.0));
    waitFor(1);
  }
  EXPECT_LT(least, 0.01);
  EXPECT_TRUE(away) << "a state older than kMaxStateAge is not rendered";
  SlowLink::wait = 0;
  DeviceStatus status = DeviceStatus::reconnecting;
  for (int i = 0; i < 2000 && status != DeviceStatus::ok; ++i) {
    waitFor(1);
    status = device->exchange(Vec3::Zero(), 1e-3).status;
  }
  EXPECT_EQ(status, DeviceStatus::ok);
}

} // namespace
} // namespace patina::test
