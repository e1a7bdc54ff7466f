#include "haptics/simulation/wire_benchmark.h"

#include <atomic>
#include <cmath>
#include <sched.h>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/error.h"
#include "haptics/device/realtime.h"
#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_device.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/law/plane.h"
#include "haptics/link/linked_device.h"
#include "haptics/servo/servo_loop.h"

namespace patina {
namespace {

constexpr double kRate = 1000;
constexpr double kOff = 1.2e-4; // counts [m]; the hand moves twice as far per frame
constexpr double kSlack = 1e-4; // tolerance of a state's time [s]
constexpr double kLate = 8e-3;  // delay of a late reply [s]

// A hand that holds the handle without oscillation.
FalconEmulatorSpec held() {
  return {.body = {.mass = 0.25, .damping = 12, .spring = 300, .friction = 0}};
}

Vec3 circle(double t) { // [m]; crosses the plane z = 0
  return 0.015 * Vec3(std::cos(16 * t), std::sin(16 * t), 0.5 * std::sin(2 * t) - 0.3);
}

struct Place {
  double t;
  Vec3 handle;
};

// Records the handle's position at each frame, in the link's thread.
class Witness {
 public:
  explicit Witness(std::size_t room) : places_(room) {}
  void add(double t, const Vec3& handle) noexcept {
    const std::size_t next = count_.load(std::memory_order_relaxed);
    places_[next % places_.size()] = {t, handle};
    count_.store(next + 1, std::memory_order_release);
  }
  // Distance of `place` to the nearest frame between two times; -1 without a frame.
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

// Wraps the driver, counts accepted replies of faulty frames and sorts the faults by their cause.
class JudgedLink final : public DeviceLink {
 public:
  JudgedLink(std::unique_ptr<DeviceLink> link, std::shared_ptr<DeviceClock> clock,
             WireBenchmark& run, std::atomic<int>& processor)
      : link_(std::move(link)), clock_(std::move(clock)), run_(run), processor_(processor) {}
  Opening open() noexcept override { return link_->open(); }
  DeviceState exchange(const Vec3& force) noexcept override {
    processor_.store(sched_getcpu(), std::memory_order_relaxed);
    const std::uint64_t before = run_.injected;
    const double begun = clock_->now();
    const DeviceState state = link_->exchange(force);
    // A state with an age reports its delay; after such a long exchange no reply is late.
    if (run_.injected != before && effectiveStatus(state) == DeviceStatus::ok && state.age == 0 &&
        clock_->now() - begun < kLate)
      ++run_.undetected_faults;
    const bool is_faulty =
        effectiveStatus(state) != DeviceStatus::ok && state.status != DeviceStatus::calibrating;
    tally_.add({begun, clock_->now(), run_.injected != seen_, is_faulty});
    seen_ = run_.injected;
    return state;
  }
  void close() noexcept override {
    tally_.dropLast();
    run_.causes = tally_.causes();
    link_->close();
  }

 private:
  std::unique_ptr<DeviceLink> link_;
  std::shared_ptr<DeviceClock> clock_;
  WireBenchmark& run_;
  std::atomic<int>& processor_;
  FaultTally tally_;
  std::uint64_t seen_ = 0; // injected faults up to the last exchange
};

// Sits between servo and link and compares each state with the recorded positions.
class Judged final : public Device {
 public:
  Judged(std::unique_ptr<Device> device, std::shared_ptr<DeviceClock> clock, const Witness& witness,
         WireBenchmark& run, std::vector<double>& ages, std::atomic<int>& processor)
      : device_(std::move(device)), clock_(std::move(clock)), witness_(witness), run_(run),
        ages_(ages), processor_(processor) {}
  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const double asked = clock_->now();
    if (exchanges_++ == 0) first_ = asked;
    processor_.store(sched_getcpu(), std::memory_order_relaxed);
    periods_ = std::llround((asked - first_) * kRate);
    const DeviceState state = device_->exchange(force, dt);
    if (effectiveStatus(state) != DeviceStatus::ok) return state;
    const double now = clock_->now();
    if (ages_.size() < ages_.capacity()) ages_.push_back(1e6 * state.age);
    const double off = witness_.off(asked - state.age - kSlack, now, state.position);
    run_.max_error = std::max(run_.max_error, off);
    if (off < 0 || off > kOff) ++run_.outdated_states;
    return state;
  }
  // Periods between the first and the last exchange that are neither an exchange nor missed. One is
  // tolerated, because both may be late by part of a period.
  std::int64_t uncounted(std::uint64_t missed) const noexcept {
    const auto known = static_cast<std::int64_t>(exchanges_ + missed) - 1;
    return std::max<std::int64_t>(std::abs(periods_ - known) - 1, 0);
  }

 private:
  std::unique_ptr<Device> device_;
  std::shared_ptr<DeviceClock> clock_;
  const Witness& witness_;
  WireBenchmark& run_;
  std::vector<double>& ages_;
  std::atomic<int>& processor_;
  std::uint64_t exchanges_ = 0;
  double first_ = 0;         // [s]
  std::int64_t periods_ = 0; // since first_
};

// The same device driven by a timer only: alternately 0.1 s on the servo's processor, for the
// wake-up latency, and 0.1 s on the link's, for the round trips. Other work, mainly disk
// interrupts, loads the processors unevenly.
struct Bare {
  explicit Bare(std::size_t room) {
    late.reserve(room);
    round.reserve(room);
  }
  void run(const std::atomic<bool>& stop, const std::atomic<int>& servos,
           const std::atomic<int>& links) {
    requestRealtime();
    const auto clock = systemClock();
    FalconEmulator emulator(held(), clock);
    FalconLine line(emulator.plug(), clock);
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
  int on_ = -1; // current processor
};

constexpr WireFault kKinds[] = {WireFault::mute,    WireFault::shortened,   WireFault::corrupt,
                                WireFault::flipped, WireFault::late,        WireFault::repeated,
                                WireFault::stale,   WireFault::out_of_order};

} // namespace

WireBenchmark runOnEmulatedWire(const WireBenchmarkSpec& spec, Progress& progress) {
  if (!(spec.seconds >= 0.1 && spec.seconds <= 36000 && spec.load >= 0 && spec.load <= 64))
    throw std::invalid_argument("wire run: 0.1 to 36000 s under a load of 0 to 64 threads");
  const auto room = static_cast<std::size_t>(1.1 * kRate * spec.seconds) + 1000;
  WireBenchmark run;
  Witness witness(1024);
  std::vector<double> ages, late;
  ages.reserve(room);
  late.reserve(room);
  const LinkedSpec linked{.guard = falconGuard(), .notes = std::make_shared<LinkStatistics>(room)};
  FalconEmulator emulator(held(), linked.clock);
  std::mt19937 random(spec.seed);
  emulator.on_frame = [&](double t, const std::array<int, 3>&) {
    emulator.rest = circle(t);
    witness.add(t, emulator.handle());
    if (spec.faults_per_thousand == 0 || random() % 1000 >= spec.faults_per_thousand) return;
    emulator.faults = {kKinds[random() % std::size(kKinds)], 1};
    ++run.injected;
  };
  std::atomic<bool> stop{false};
  std::atomic<int> servos{-1}, links{-1}; // their processors
  Bare bare(room);
  {
    auto link = std::make_unique<JudgedLink>(
        makeFalconLink([&] { return emulator.plug(); }, {}, linked.clock), linked.clock, run,
        links);
    auto judged = std::make_unique<Judged>(makeLinkedDevice(std::move(link), linked), linked.clock,
                                           witness, run, ages, servos);
    const Judged& counts = *judged; // owned by the loop; read only after its end
    ServoLoop loop(std::move(judged), kRate);
    HapticProperties haptics;
    haptics.stiffness = 500;
    loop.publish(planeSnapshot(haptics, {}));
    std::thread timer([&] { bare.run(stop, servos, links); });
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
  run.round_trips = linked.notes->round_trips;
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
