#include "haptics/devices/falcon/wire_run.h"

#include <atomic>
#include <cmath>
#include <sched.h>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/error.h"
#include "haptics/contact/plane.h"
#include "haptics/devices/falcon/emulated_falcon.h"
#include "haptics/devices/falcon/falcon_device.h"
#include "haptics/devices/falcon/falcon_frame.h"
#include "haptics/devices/link/linked_device.h"
#include "haptics/servo/realtime.h"
#include "haptics/servo/servo_loop.h"

namespace patina {
namespace {

constexpr double kRate = 1000;
constexpr double kOff = 1.2e-4; // [m]: counts; the hand goes twice as far from frame to frame
constexpr double kSlack = 1e-4; // [s], of the time that a state says
constexpr double kLate = 8e-3;  // [s], of an answer that is spoilt so

// A hand that holds it without swinging.
FalconBenchSpec held() {
  return {.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
}

Vec3 circle(double t) { // [m]; through the plane z = 0
  return 0.015 * Vec3(std::cos(16 * t), std::sin(16 * t), 0.5 * std::sin(2 * t) - 0.3);
}

struct Place {
  double t;
  Vec3 handle;
};

// Notes where the handle is with each frame, in the thread of the link.
class Witness {
 public:
  explicit Witness(std::size_t room) : places_(room) {}
  void add(double t, const Vec3& handle) noexcept {
    const std::size_t next = count_.load(std::memory_order_relaxed);
    places_[next % places_.size()] = {t, handle};
    count_.store(next + 1, std::memory_order_release);
  }
  // How far `place` is from that of a frame between two times, the nearest; -1 where there is none.
  double off(double from, double to, const Vec3& place) const noexcept {
    const std::size_t end = count_.load(std::memory_order_acquire);
    const std::size_t most = std::min(end, places_.size() / 2);
    double off = -1;
    for (std::size_t back = 1; back <= most; ++back) {
      const Place& frame = places_[(end - back) % places_.size()];
      if (frame.t < from) break;
      const double apart = (frame.handle - place).norm();
      if (frame.t <= to && (off < 0 || apart < off)) off = apart;
    }
    return off;
  }

 private:
  std::vector<Place> places_;
  std::atomic<std::size_t> count_{0};
};

// Around the driver: a frame whose answer was spoilt gives no state.
class JudgedLink final : public DeviceLink {
 public:
  JudgedLink(std::unique_ptr<DeviceLink> link, std::shared_ptr<DeviceClock> clock, WireRun& run,
             std::atomic<int>& processor)
      : link_(std::move(link)), clock_(std::move(clock)), run_(run), processor_(processor) {}
  Opening open() noexcept override { return link_->open(); }
  DeviceState turn(const Vec3& force) noexcept override {
    processor_.store(sched_getcpu(), std::memory_order_relaxed);
    const std::uint64_t before = run_.injected;
    const double begun = clock_->now();
    const DeviceState state = link_->turn(force);
    // What says that it may be old is noticed; a turn that took this long has none that is late.
    if (run_.injected != before && judge(state) == DeviceStatus::ok && state.age == 0 &&
        clock_->now() - begun < kLate)
      ++run_.unnoticed;
    return state;
  }
  void close() noexcept override { link_->close(); }

 private:
  std::unique_ptr<DeviceLink> link_;
  std::shared_ptr<DeviceClock> clock_;
  WireRun& run_;
  std::atomic<int>& processor_;
};

// Between servo and link: holds each state against the witness.
class Judged final : public Device {
 public:
  Judged(std::unique_ptr<Device> device, std::shared_ptr<DeviceClock> clock, const Witness& witness,
         WireRun& run, std::vector<double>& ages, std::atomic<int>& processor)
      : device_(std::move(device)), clock_(std::move(clock)), witness_(witness), run_(run),
        ages_(ages), processor_(processor) {}
  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const double asked = clock_->now();
    if (exchanges_++ == 0) first_ = asked;
    processor_.store(sched_getcpu(), std::memory_order_relaxed);
    periods_ = std::llround((asked - first_) * kRate);
    const DeviceState state = device_->exchange(force, dt);
    if (judge(state) != DeviceStatus::ok) return state;
    const double now = clock_->now();
    if (ages_.size() < ages_.capacity()) ages_.push_back(1e6 * state.age);
    if (state.position == last_ && state.age > 1e-3) ++run_.aged;
    last_ = state.position;
    const double off = witness_.off(asked - state.age - kSlack, now, state.position);
    run_.worst = std::max(run_.worst, off);
    if (off < 0 || off > kOff) ++run_.stale;
    return state;
  }
  // Periods between its first and its last exchange that are neither an exchange nor missed. Both
  // may be late by part of one.
  std::int64_t uncounted(std::uint64_t missed) const noexcept {
    const auto known = static_cast<std::int64_t>(exchanges_ + missed) - 1;
    return std::max<std::int64_t>(std::abs(periods_ - known) - 1, 0);
  }

 private:
  std::unique_ptr<Device> device_;
  std::shared_ptr<DeviceClock> clock_;
  const Witness& witness_;
  WireRun& run_;
  std::vector<double>& ages_;
  std::atomic<int>& processor_;
  Vec3 last_ = Vec3::Zero();
  std::uint64_t exchanges_ = 0;
  double first_ = 0;         // [s]
  std::int64_t periods_ = 0; // since
};

// The same device turned by a timer and nothing else: .1 s on the processor on which the servo
// is, to hold its wake-ups against, and .1 s on the link's, for the round trips. What else a
// processor has to do, interrupts of the disk above all, is not shared evenly.
struct Bare {
  explicit Bare(std::size_t room) {
    late.reserve(room);
    round.reserve(room);
  }
  void turn(const std::atomic<bool>& stop, const std::atomic<int>& servos,
            const std::atomic<int>& links) {
    requestRealtime();
    const auto clock = systemClock();
    FalconBench bench(held(), clock);
    FalconLine line(bench.plug(), clock);
    line.toRunning();
    PeriodicClock timer(monotonicNs() + 500'000, 1'000'000); // between the servo's ticks
    while (!stop.load(std::memory_order_relaxed)) {
      const std::int64_t due = timer.nextDeadline();
      const bool with_servo = due % 200'000'000 < 100'000'000;
      if (const int wanted = (with_servo ? servos : links).load(std::memory_order_relaxed);
          wanted != on_ && wanted >= 0) {
        cpu_set_t set;
        CPU_ZERO(&set);
        CPU_SET(static_cast<std::size_t>(wanted), &set);
        if (sched_setaffinity(0, sizeof set, &set) == 0) on_ = wanted;
      }
      sleepUntil(due);
      const std::int64_t woke = monotonicNs();
      timer.woke(woke);
      FalconBytes bytes;
      line.send(encoded({}));
      line.receive(bytes, 2e-3);
      if (with_servo && late.size() < late.capacity())
        late.push_back(1e-3 * static_cast<double>(woke - due));
      if (!with_servo && round.size() < round.capacity())
        round.push_back(1e-3 * static_cast<double>(monotonicNs() - woke));
    }
  }
  std::vector<double> late, round; // [us]

 private:
  int on_ = -1; // which processor
};

constexpr WireFault kKinds[] = {WireFault::mute,    WireFault::shortened,   WireFault::corrupt,
                                WireFault::flipped, WireFault::late,        WireFault::repeated,
                                WireFault::stale,   WireFault::out_of_order};

} // namespace

WireRun runOnEmulatedWire(const WireRunSpec& spec, Progress& progress) {
  if (!(spec.seconds >= 0.1 && spec.seconds <= 36000 && spec.load >= 0 && spec.load <= 64))
    throw std::invalid_argument("wire run: 0.1 to 36000 s under a load of 0 to 64 threads");
  const auto room = static_cast<std::size_t>(1.1 * kRate * spec.seconds) + 1000;
  WireRun run;
  Witness witness(1024);
  std::vector<double> ages, late;
  ages.reserve(room);
  late.reserve(room);
  const LinkedSpec linked{.guard = falconGuard(), .notes = std::make_shared<LinkNotes>(room)};
  FalconBench bench(held(), linked.clock);
  std::mt19937 random(spec.seed);
  bench.on_frame = [&](double t, const std::array<int, 3>&) {
    bench.rest = circle(t);
    witness.add(t, bench.handle());
    if (spec.faults_per_thousand == 0 || random() % 1000 >= spec.faults_per_thousand) return;
    bench.faults = {kKinds[random() % std::size(kKinds)], 1};
    ++run.injected;
  };
  std::atomic<bool> stop{false};
  std::atomic<int> servos{-1}, links{-1}; // their processors
  Bare bare(room);
  {
    auto link = std::make_unique<JudgedLink>(
        makeFalconLink([&] { return bench.plug(); }, {}, linked.clock), linked.clock, run, links);
    auto judged = std::make_unique<Judged>(makeLinkedDevice(std::move(link), linked), linked.clock,
                                           witness, run, ages, servos);
    const Judged& counts = *judged; // the loop's, but for the end
    ServoLoop loop(std::move(judged), kRate);
    HapticProperties haptics;
    haptics.stiffness = 500;
    loop.publish(planeSnapshot(haptics, {}));
    std::thread timer([&] { bare.turn(stop, servos, links); });
    std::vector<std::thread> load;
    for (int i = 0; i < spec.load; ++i)
      load.emplace_back([&] {
        while (!stop.load(std::memory_order_relaxed)) {
        }
      });
    const auto end = [&] {
      stop = true;
      timer.join();
      for (std::thread& thread : load) thread.join();
      load.clear();
      loop.stop();
    };
    loop.start();
    const double begin = linked.clock->now();
    const auto drain = [&] {
      for (ToolSample sample; loop.samples().pop(sample);)
        if (late.size() < late.capacity()) late.push_back(1e-3 * sample.late_ns);
    };
    for (double t = 0; t < spec.seconds; t = linked.clock->now() - begin) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      drain();
      progress.report(std::min(t / spec.seconds, 1.0), "turning with an emulated Falcon");
      if (!progress.cancelled()) continue;
      end();
      throw Cancelled();
    }
    end();
    drain();
    const ServoTiming timing = loop.timing();
    run.policy = timing.policy;
    run.realtime = timing.realtime;
    run.ticks = timing.ticks;
    run.missed = timing.missed;
    run.uncounted = static_cast<std::uint64_t>(counts.uncounted(timing.missed));
  }
  run.turns = linked.notes->turns;
  run.faults = linked.notes->faults;
  run.overruns = linked.notes->overruns;
  const Percentiles round = linked.notes->round_trip.late();
  run.round_us = {1e-3 * round.p50, 1e-3 * round.p99, 1e-3 * round.p999, 1e-3 * round.max};
  run.late_us = percentiles(std::move(late));
  run.age_us = percentiles(std::move(ages));
  run.bare_late_us = percentiles(std::move(bare.late));
  run.bare_round_us = percentiles(std::move(bare.round));
  return run;
}

} // namespace patina
