#include "haptics/servo/servo_loop.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "core/timing_window.h"
#include "haptics/device/realtime.h"
#include "haptics/servo/cross_fade.h"
#include "haptics/servo/tick_record.h"

namespace patina {
namespace {

constexpr std::size_t kTimingTicks = 8192;
constexpr std::size_t kSamples = 16384; // covers a window that hangs for 16 s at 1 kHz
constexpr std::size_t kPaintSamples = 4096;
constexpr double kNsPerSecond = 1e9;
constexpr int kRateTicks = 250;

} // namespace

struct ServoLoop::Impl {
  Impl(std::unique_ptr<Device> device_in, double rate_hz)
      : device(std::move(device_in)), period_ns(periodNs(rate_hz)),
        samples(std::max<std::size_t>(kSamples, static_cast<std::size_t>(rate_hz))),
        paint_samples(std::max<std::size_t>(kPaintSamples, static_cast<std::size_t>(rate_hz))),
        window(kTimingTicks) {
    if (!device) throw std::invalid_argument("servo loop: no device");
  }

  void run() noexcept {
    pthread_setname_np(pthread_self(), "servo"); // name in debuggers and /proc
    grant.store(requestRealtime(), std::memory_order_release);

    const std::int64_t start = monotonicNs();
    rate_mark = start;
    PeriodicClock clock(start, period_ns);
    std::int64_t last_wake = start;
    CrossFade law;
    Vec3 force = Vec3::Zero();
    while (!stopping.load(std::memory_order_relaxed)) {
      const std::int64_t deadline = clock.nextDeadline();
      sleepUntil(deadline);
      const std::int64_t woke = monotonicNs();
      missed.fetch_add(static_cast<std::uint64_t>(clock.woke(woke)), std::memory_order_relaxed);
      const double dt = static_cast<double>(woke - last_wake) / kNsPerSecond;
      last_wake = woke;

      const DeviceState state = device->exchange(force, dt);
      const DeviceStatus status = effectiveStatus(state);
      if (status == DeviceStatus::repositioning) {
        force.setZero();
        law.resetContact();
        measureRate(woke);
        continue;
      }
      device_status.store(status, std::memory_order_relaxed);
      if (status != DeviceStatus::ok) {
        force.setZero();
        if (!holds(status)) break;
        law.resetContact(); // the tip may return at any position
        rate_mark = woke;
        ticks_since_mark = 0;
        continue;
      }
      if (!law.fading()) {
        exchange.protect(law.active()); // the old law may have to fade out
        law.fadeTo(exchange.latest());
      }
      ToolSample sample;
      sample.t = static_cast<double>(woke - start) / kNsPerSecond;
      const std::int64_t before = monotonicNs();
      const Contact contact = law.tick(state.position, dt);
      record(contact, sample);
      sample.buttons = static_cast<std::uint8_t>(state.buttons);
      force = contact.force;
      const std::int64_t step = monotonicNs() - before;
      sample.step_ns = static_cast<std::uint32_t>(std::min<std::int64_t>(step, UINT32_MAX));
      sample.late_ns =
          static_cast<std::uint32_t>(std::clamp<std::int64_t>(woke - deadline, 0, UINT32_MAX));
      window.record(woke - deadline);
      measureRate(woke);
      samples.push(sample);
      paint_samples.push(sample);
    }
    // Leaves no force behind.
    device->exchange(Vec3::Zero(), static_cast<double>(period_ns) / kNsPerSecond);
  }

  void measureRate(std::int64_t woke) noexcept {
    if (++ticks_since_mark < kRateTicks) return;
    measured_rate.store(kRateTicks * kNsPerSecond / static_cast<double>(woke - rate_mark),
                        std::memory_order_relaxed);
    rate_mark = woke;
    ticks_since_mark = 0;
  }

  std::unique_ptr<Device> device;
  std::int64_t period_ns;
  SnapshotExchange<HapticSnapshot> exchange;
  Ring<ToolSample> samples;
  Ring<ToolSample> paint_samples;
  TimingWindow window;
  std::thread thread;
  std::atomic<bool> stopping{false};
  std::atomic<std::uint64_t> missed{0};
  std::atomic<double> measured_rate{0};
  std::atomic<DeviceStatus> device_status{DeviceStatus::ok};
  std::atomic<RealtimeGrant> grant{RealtimeGrant{-1, -1}}; // not requested before the first start
  std::int64_t rate_mark = 0;                              // servo thread only, like the next
  int ticks_since_mark = 0;
};

ServoLoop::ServoLoop(std::unique_ptr<Device> device, double rate_hz)
    : impl_(std::make_unique<Impl>(std::move(device), rate_hz)) {}

ServoLoop::~ServoLoop() {
  stop();
}

void ServoLoop::start() {
  if (running()) return;
  impl_->stopping.store(false);
  impl_->device_status.store(DeviceStatus::ok);
  impl_->thread = std::thread([this] { impl_->run(); });
}

void ServoLoop::stop() {
  if (!running()) return;
  impl_->stopping.store(true);
  impl_->thread.join();
}

bool ServoLoop::running() const {
  return impl_->thread.joinable();
}

void ServoLoop::publish(std::shared_ptr<const HapticSnapshot> snapshot) {
  impl_->exchange.publish(std::move(snapshot));
}

void ServoLoop::collect() {
  impl_->exchange.collect();
}

Ring<ToolSample>& ServoLoop::paint_samples() {
  return impl_->paint_samples;
}

Ring<ToolSample>& ServoLoop::samples() {
  return impl_->samples;
}

ServoTiming ServoLoop::timing() const {
  const RealtimeGrant grant = impl_->grant.load(std::memory_order_acquire);
  ServoTiming timing;
  timing.policy = policyText(grant);
  timing.realtime = grant.fifo_error == 0;
  timing.ticks = impl_->window.count();
  timing.missed = impl_->missed.load(std::memory_order_relaxed);
  timing.late_p99 = impl_->window.late().p99 * 1e-3;
  timing.rate_hz = impl_->measured_rate.load(std::memory_order_relaxed);
  timing.device = impl_->device_status.load(std::memory_order_relaxed);
  return timing;
}

} // namespace patina
