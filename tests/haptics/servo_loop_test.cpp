#include "haptics/servo/servo_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "core/percentiles.h"
#include "core/timing_window.h"
#include "haptics/device/realtime.h"
#include "support/simulated_device.h"

namespace patina {
namespace {

std::shared_ptr<const HapticSnapshot> sphereSnapshot(double stiffness) {
  const double radius = 0.05;
  FieldSpec spec;
  spec.resolution = 48;
  const FieldGrid grid = gridAround(Box3(Vec3::Constant(-radius), Vec3::Constant(radius)), spec);
  auto field = std::make_shared<const SurfaceField>(
      sampleFunction([=](const Vec3& p) { return p.norm() - radius; }, grid, spec.band));
  Scene scene;
  scene.haptics.stiffness = stiffness;
  return compileStages(scene, withSamples(field));
}

// A device that stands still inside the sphere and keeps the force that it received.
class WitnessDevice final : public Device {
 public:
  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    force_x.store(force.x());
    if (dt <= 0) bad_dt.store(true);
    exchanges.fetch_add(1);
    return {Vec3(0.049, 0, 0)};
  }

  std::atomic<double> force_x{-1};
  std::atomic<int> exchanges{0};
  std::atomic<bool> bad_dt{false};
};

void waitForExchanges(const WitnessDevice& device, int count) {
  const int until = device.exchanges.load() + count;
  for (int i = 0; i < 5000 && device.exchanges.load() < until; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_GE(device.exchanges.load(), until) << "the servo does not run";
}

TEST(ServoLoop, RendersNothingBeforeTheFirstSnapshotAndAnEditFromTheNextTick) {
  auto owned = std::make_unique<WitnessDevice>();
  WitnessDevice& device = *owned;
  ServoLoop loop(std::move(owned));
  loop.start();
  waitForExchanges(device, 20);
  EXPECT_EQ(device.force_x.load(), 0.0);
  loop.publish(sphereSnapshot(500));
  waitForExchanges(device, 20);
  EXPECT_NEAR(device.force_x.load(), 500 * 0.001, 0.02);
  loop.publish(sphereSnapshot(1000));
  waitForExchanges(device, 20);
  EXPECT_NEAR(device.force_x.load(), 1000 * 0.001, 0.04);
  loop.stop();
  EXPECT_EQ(device.force_x.load(), 0.0) << "a stopped loop leaves no force behind";
  EXPECT_FALSE(device.bad_dt.load());
}

// T-RAMP in the loop itself: nothing, 1 N, 2 N, and back, by 0.05 N a tick at most.
TEST(ServoLoop, EditsWhileTouchingNeverStepTheForce) {
  auto owned = std::make_unique<WitnessDevice>();
  WitnessDevice& device = *owned;
  ServoLoop loop(std::move(owned));
  loop.start();
  for (const double stiffness : {1000.0, 2000.0, 200.0}) {
    loop.publish(sphereSnapshot(stiffness)); // each with a field of its own
    waitForExchanges(device, 60);
  }
  loop.stop();
  ToolSample sample;
  double last = 0, most = 0;
  while (loop.samples().pop(sample)) {
    ASSERT_LE(std::abs(sample.force.x() - last), 0.05);
    ASSERT_FALSE(sample.fault);
    last = sample.force.x();
    most = std::max(most, last);
  }
  EXPECT_NEAR(most, 2, 0.1);
  EXPECT_NEAR(last, 0.2, 0.02);
}

TEST(ServoLoop, ReportsEveryTickThroughTheRing) {
  ServoLoop loop(std::make_unique<StillDevice>(Vec3(0.049, 0, 0)));
  loop.publish(sphereSnapshot(500));
  loop.start();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  loop.stop();
  ToolSample sample;
  std::uint64_t drained = 0;
  double last_t = -1;
  while (loop.samples().pop(sample)) {
    EXPECT_GT(sample.t, last_t);
    last_t = sample.t;
    EXPECT_TRUE(sample.contact);
    EXPECT_NEAR(sample.vcp.x(), 0.05, 1e-4);
    ++drained;
  }
  const ServoTiming timing = loop.timing();
  EXPECT_EQ(drained, timing.ticks);
  EXPECT_GT(drained, 100u);
  EXPECT_FALSE(timing.policy.empty());
  // Ticks and missed deadlines together account for the whole time.
  EXPECT_NEAR(static_cast<double>(timing.ticks + timing.missed), 300, 60);
}

// On any machine the samples report the time and lateness of each tick.
TEST(ServoLoop, MeasuresRateAndLatenessOfItsTicks) {
  ServoLoop loop(std::make_unique<StillDevice>(Vec3(0.049, 0, 0)), 4000);
  loop.start();
  for (int i = 0; i < 5000 && loop.timing().ticks < 900; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  loop.stop();
  std::vector<ToolSample> samples;
  for (ToolSample sample; loop.samples().pop(sample);) samples.push_back(sample);
  const ServoTiming timing = loop.timing();
  ASSERT_EQ(samples.size(), timing.ticks);
  ASSERT_GT(samples.size(), 500U);
  const std::size_t mark = samples.size() / 250 * 250 - 1; // the rate is measured every 250 ticks
  EXPECT_NEAR(timing.rate_hz * (samples[mark].t - samples[mark - 250].t), 250, 1e-3);
  std::vector<double> late;
  for (const ToolSample& sample : samples) late.push_back(1e-3 * sample.late_ns);
  EXPECT_NEAR(timing.late_p99, percentiles(std::move(late)).p99, 1e-6);
}

// Rests in the sphere until the test changes its status or lets it age.
class FailingDevice final : public Device {
 public:
  DeviceState exchange(const Vec3& force, double) noexcept override {
    DeviceState state{Vec3(0.049, 0, 0)};
    state.status = status.load();
    state.age = age.load();
    force_x.store(force.x());
    exchanges.fetch_add(1);
    return state;
  }

  std::atomic<DeviceStatus> status{DeviceStatus::ok};
  std::atomic<double> age{0}, force_x{-1};
  std::atomic<int> exchanges{0};
};

void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// A published snapshot fades in.
void waitForForce(const FailingDevice& device, double force) {
  for (int i = 0; i < 5000 && std::abs(device.force_x.load() - force) > 0.02; ++i) pause(1);
  EXPECT_NEAR(device.force_x.load(), force, 0.02);
}

TEST(ServoLoop, EndsWithoutForceAndReportsTheCauseIfItsDeviceFails) {
  struct Case {
    DeviceStatus status;
    double age;
    DeviceStatus told;
  };
  for (const Case& failure : {Case{DeviceStatus::gone, 0, DeviceStatus::gone},
                              Case{DeviceStatus::protocol_error, 0, DeviceStatus::protocol_error},
                              Case{DeviceStatus::timed_out, 0, DeviceStatus::timed_out},
                              Case{DeviceStatus::ok, 2 * kMaxStateAge, DeviceStatus::timed_out}}) {
    auto owned = std::make_unique<FailingDevice>();
    FailingDevice& device = *owned;
    ServoLoop loop(std::move(owned));
    loop.publish(sphereSnapshot(500));
    loop.start();
    waitForForce(device, 0.5);
    EXPECT_EQ(loop.timing().device, DeviceStatus::ok);
    device.age = failure.age;
    device.status = failure.status;
    for (int i = 0; i < 2000 && loop.timing().device == DeviceStatus::ok; ++i) pause(1);
    EXPECT_EQ(loop.timing().device, failure.told);
    pause(50);
    EXPECT_EQ(device.force_x.load(), 0);
    const int ended = device.exchanges.load();
    device.status = DeviceStatus::ok; // too late
    device.age = 0;
    pause(50);
    EXPECT_EQ(device.exchanges.load(), ended);
    EXPECT_EQ(loop.timing().device, failure.told);
    loop.stop(); // a loop that has ended can be started again
    loop.start();
    waitForForce(device, 0.5);
    EXPECT_EQ(loop.timing().device, DeviceStatus::ok);
  }
}

TEST(ServoLoop, WaitsWithoutForceWhileItsDeviceCalibrates) {
  auto owned = std::make_unique<FailingDevice>();
  FailingDevice& device = *owned;
  device.status = DeviceStatus::calibrating;
  ServoLoop loop(std::move(owned));
  loop.publish(sphereSnapshot(500));
  loop.start();
  for (int i = 0; i < 2000 && device.exchanges.load() < 50; ++i) pause(1);
  EXPECT_GE(device.exchanges.load(), 50);
  EXPECT_EQ(device.force_x.load(), 0);
  EXPECT_EQ(loop.timing().device, DeviceStatus::calibrating);
  ToolSample sample;
  EXPECT_FALSE(loop.samples().pop(sample)) << "an invalid position is not rendered";
  device.status = DeviceStatus::ok;
  waitForForce(device, 0.5);
  EXPECT_EQ(loop.timing().device, DeviceStatus::ok);
}

TEST(ServoLoop, SendsNoForceOnceItsDeviceCalibratesInContact) {
  auto owned = std::make_unique<FailingDevice>();
  FailingDevice& device = *owned;
  ServoLoop loop(std::move(owned));
  loop.publish(sphereSnapshot(500));
  loop.start();
  waitForForce(device, 0.5);
  device.status = DeviceStatus::calibrating;
  for (int i = 0; i < 2000 && device.force_x.load() != 0; ++i) pause(1);
  EXPECT_EQ(device.force_x.load(), 0);
}

TEST(ServoLoop, ExcludesCalibrationTimeFromItsRate) {
  auto owned = std::make_unique<FailingDevice>();
  FailingDevice& device = *owned;
  device.status = DeviceStatus::calibrating;
  ServoLoop loop(std::move(owned));
  loop.start();
  pause(700);
  device.status = DeviceStatus::ok;
  for (int i = 0; i < 5000 && loop.timing().ticks < 250; ++i) pause(1);
  loop.stop();
  std::vector<ToolSample> samples;
  for (ToolSample sample; loop.samples().pop(sample);) samples.push_back(sample);
  const std::size_t mark = samples.size() / 250 * 250 - 1; // the rate is measured every 250 ticks
  ASSERT_LT(mark, samples.size());
  const double ticks = loop.timing().rate_hz * (samples[mark].t - samples[mark - 249].t);
  EXPECT_GT(ticks, 180); // 249, and 65 if those 700 ms counted
  EXPECT_LT(ticks, 250);
}

TEST(ServoLoop, RendersAStateThatIsNotTooOld) {
  auto owned = std::make_unique<FailingDevice>();
  FailingDevice& device = *owned;
  device.age = 0.5 * kMaxStateAge;
  ServoLoop loop(std::move(owned));
  loop.publish(sphereSnapshot(500));
  loop.start();
  waitForForce(device, 0.5);
}

TEST(ServoLoop, StartsAndStopsRepeatedly) {
  ServoLoop loop(std::make_unique<StillDevice>(Vec3::Zero()), 10000);
  for (int i = 0; i < 20; ++i) {
    loop.start();
    EXPECT_TRUE(loop.running());
    loop.stop();
    EXPECT_FALSE(loop.running());
  }
}

TEST(ServoLoop, FreesSnapshotsThatItNoLongerUses) {
  ServoLoop loop(std::make_unique<StillDevice>(Vec3(0.049, 0, 0)));
  loop.start();
  std::weak_ptr<const HapticSnapshot> first;
  {
    auto snapshot = sphereSnapshot(500);
    first = snapshot;
    loop.publish(std::move(snapshot));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(first.expired()) << "the servo still reads it";
  loop.publish(sphereSnapshot(600));
  for (int i = 0; i < 1000 && !first.expired(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    loop.collect();
  }
  EXPECT_TRUE(first.expired());
}

TEST(ServoLoop, RefusesARateOutOfRange) {
  EXPECT_THROW(ServoLoop(std::make_unique<StillDevice>(Vec3::Zero()), 50), std::invalid_argument);
  EXPECT_THROW(ServoLoop(std::make_unique<StillDevice>(Vec3::Zero()), 20000),
               std::invalid_argument);
  EXPECT_THROW(ServoLoop(nullptr), std::invalid_argument);
}

TEST(PeriodicClock, CountsAndSkipsMissedDeadlines) {
  PeriodicClock clock(0, 1000);
  EXPECT_EQ(clock.nextDeadline(), 1000);
  EXPECT_EQ(clock.woke(1400), 0);
  EXPECT_EQ(clock.nextDeadline(), 2000);
  EXPECT_EQ(clock.woke(5500), 3) << "3000, 4000 and 5000 went by";
  EXPECT_EQ(clock.nextDeadline(), 6000);
}

TEST(TimingWindow, GivesNearestRankPercentilesOfTheLastTicks) {
  TimingWindow window(100);
  EXPECT_EQ(window.late().max, 0.0);
  for (int i = 0; i < 50; ++i) window.record(1'000'000); // will leave the window
  for (int i = 1; i <= 100; ++i) window.record(i);
  EXPECT_EQ(window.late().p50, 50);
  EXPECT_EQ(window.late().p99, 99);
  EXPECT_EQ(window.late().p999, 100);
  window.record(-5);
  EXPECT_EQ(window.late().max, 100) << "a wake-up before its deadline is not late";
}

} // namespace
} // namespace patina
