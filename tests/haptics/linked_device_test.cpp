// A device of a thread of its own, in real time over the emulated wire.
#include "haptics/devices/link/linked_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "core/error.h"
#include "haptics/devices/falcon/wire_run.h"
#include "haptics/falcon_support.h"
#include "support/longer.h"
#include "support/sanitized.h"

namespace patina::test {
namespace {

void waitFor(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// Other programs can only make a run worse: the first of twelve that nobody disturbed is enough.
TEST(EmulatedWire, TurnsAsSteadilyAsABareTimerAndNeverFeelsAnOldPlace) {
  constexpr double kMost = 100; // us
  double late = 1e9, round = 1e9;
  for (int i = 0; i < (kSanitized ? 1 : 12) && (late > kMost || round > kMost); ++i) {
    Progress progress;
    const WireRun run = runOnEmulatedWire({.seconds = 0.1 * longer(50)}, progress);
    EXPECT_EQ(run.stale, 0U) << run.worst;
    EXPECT_EQ(run.uncounted, 0U) << "an overrun that nobody has counted";
    EXPECT_GT(run.turns, run.ticks / 2);
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

TEST(EmulatedWire, FaultsAmongTheFramesAreAllNoticedAndNoneIsFelt) {
  Progress progress;
  const WireRun run = runOnEmulatedWire({.seconds = 3, .faults_per_thousand = 20}, progress);
  EXPECT_GT(run.injected, 5U);
  EXPECT_EQ(run.unnoticed, 0U);
  EXPECT_EQ(run.stale, 0U) << run.worst;
}

TEST(EmulatedWire, RefusesARunThatIsNone) {
  Progress progress;
  EXPECT_THROW(runOnEmulatedWire({.seconds = 0}, progress), std::invalid_argument);
  EXPECT_THROW(runOnEmulatedWire({.load = -1}, progress), std::invalid_argument);
}

// Bench and link in their own thread; what the wire carried, for the test's thread.
struct Wire {
  Wire()
      : bench({.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}}, spec.clock) {
    spec.guard = falconGuard();
    spec.guard.oldest_command = 0.1; // the test's thread is none of real time
    bench.on_frame = [this](double, const std::array<int, 3>& motors) {
      pushes = motors != std::array<int, 3>{};
      frames = frames + 1;
    };
    device =
        makeLinkedDevice(makeFalconLink([this] { return bench.plug(); }, {}, spec.clock), spec);
  }
  ~Wire() { device.reset(); }
  // Ticks until the guard lets all through.
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
  FalconBench bench;
  std::unique_ptr<Device> device;
};

TEST(LinkedDevice, AServoThatStopsLeavesNoForceAtTheWire) {
  Wire wire;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(wire.feel(Vec3(0, 0, 1)));
    const int before = wire.frames;
    waitFor(400); // no exchange
    EXPECT_FALSE(wire.pushes);
    EXPECT_GT(wire.frames, before + 10) << "frames without force are still sent";
    EXPECT_EQ(wire.spec.notes->hold, Hold::servo);
  }
}

TEST(LinkedDevice, ClosedItLeavesNoForceAndTakesNoTime) {
  Wire wire;
  ASSERT_TRUE(wire.feel(Vec3(0, 1, 0)));
  const double begin = wire.spec.clock->now();
  wire.device.reset();
  EXPECT_LT(wire.spec.clock->now() - begin, 1);
  EXPECT_FALSE(wire.pushes);
}

TEST(LinkedDevice, IsAwayUntilItIsThereAndSaysWhy) {
  Wire wire;
  ASSERT_TRUE(wire.feel(Vec3(1, 0, 0)));
  EXPECT_EQ(heldBack(*wire.spec.notes), "");
  wire.device.reset();
  wire.bench.unplug();
  wire.device = makeLinkedDevice(
      makeFalconLink([&] { return wire.bench.plug(); }, {}, wire.spec.clock), wire.spec);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(wire.device->exchange(Vec3(1, 0, 0), 1e-3).status, DeviceStatus::away);
    waitFor(1);
  }
  EXPECT_EQ(heldBack(*wire.spec.notes), "no force: the emulated Falcon is not attached");
}

// A link that keeps its caller waiting for ever longer.
class SlowLink final : public DeviceLink {
 public:
  Opening open() noexcept override { return {true, {}}; }
  DeviceState turn(const Vec3&) noexcept override {
    waitFor(wait);
    return {};
  }
  static inline std::atomic<int> wait{0};
};

TEST(LinkedDevice, NeverKeepsTheServoWaitingLongerThanItMay) {
  const LinkedSpec spec{.answer_wait = 0.5e-3};
  const auto device = makeLinkedDevice(std::make_unique<SlowLink>(), spec);
  SlowLink::wait = 0;
  while (device->exchange(Vec3::Zero(), 1e-3).status != DeviceStatus::ok) waitFor(1);
  SlowLink::wait = 200;
  double least = 1;
  bool away = false;
  for (int i = 0; i < 100; ++i) {
    const double begin = spec.clock->now();
    away = device->exchange(Vec3::Zero(), 1e-3).status == DeviceStatus::away || away;
    least = std::min(least, std::max(spec.clock->now() - begin, 0.0));
    waitFor(1);
  }
  EXPECT_LT(least, 0.01);
  EXPECT_TRUE(away) << "what is older than kOldestAge is not felt";
  SlowLink::wait = 0;
  DeviceStatus status = DeviceStatus::away;
  for (int i = 0; i < 2000 && status != DeviceStatus::ok; ++i) {
    waitFor(1);
    status = device->exchange(Vec3::Zero(), 1e-3).status;
  }
  EXPECT_EQ(status, DeviceStatus::ok);
}

} // namespace
} // namespace patina::test
