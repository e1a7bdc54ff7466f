#include <cstdlib>
#include <thread>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/law/plane.h"
#include "haptics/servo/latency.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/simulation/wire_benchmark.h"

namespace patina::cli {

namespace {

struct LatencyOptions {
  double seconds = 5, rate = 1000;
  bool wire = false;
  WireBenchmarkSpec on_wire;
  std::string device; // empty: none
};

const Keys kLatencyTestKeys = {
    {"policy", "", "policy", "what the system granted"},
    {"realtime", "", "real time", "", Shown::never},
    {"wakeups", "", "wake-ups"},
    {"rate_hz", "Hz", "rate", "", Shown::never},
    {"late_us", "us", "late", "", Shown::never, percentileParts()},
    {"wait_us", "us", "of it waiting for a processor", "absent where the kernel does not count it",
     Shown::never, percentileParts()},
    {"missed", "", "missed", "wake-ups more than a period late"},
    {"bare_late_us", "us", "late, bare timer", "with --emulated-falcon, as those below",
     Shown::never, percentileParts()},
    {"round_us", "us", "round trip", "", Shown::never, percentileParts()},
    {"bare_round_us", "us", "round trip, bare timer", "", Shown::never, percentileParts()},
    {"age_us", "us", "age of what is felt", "", Shown::never, percentileParts()},
    {"turns", "", "round trips answered"},
    {"faults", "", "faults noticed"},
    {"by_injection", "", "of them by injected faults",
     "with the exchanges until the line is trusted again, as the next"},
    {"by_delay", "", "of them by this machine, late"},
    {"unexplained", "", "of them by neither"},
    {"injected", "", "faults injected"},
    {"unnoticed", "", "of these, not noticed"},
    {"overruns", "", "round trips without a new command"},
    {"uncounted", "", "periods neither ticked nor missed"},
    {"stale", "", "old positions taken as new"},
    {"openings", "", "times it began to answer", "with --device, as the next"},
    {"held", "", "held back", "why no force, or not all of it, is given at the end", Shown::if_any},
    {"load", "", "load", "1-minute average at the start"}};

void setSpread(const char* key, const std::string& caption, const Percentiles& us, Report& report) {
  report.set(key, toJson(us));
  for (const auto& [percentile, value] :
       {std::pair{"p50", us.p50}, {"p99", us.p99}, {"p99.9", us.p999}, {"max", us.max}})
    report.tell(caption + ", " + percentile, shown(value, "us"));
}

// Runs servo, driver and an emulated Falcon beside a bare timer.
int runOnWire(const LatencyOptions& options, double load, Console& console) {
  WireBenchmarkSpec spec = options.on_wire;
  spec.seconds = options.seconds;
  const WireBenchmark run = runOnEmulatedWire(spec, console.progress());
  Report report(kLatencyTestKeys);
  report.set("policy", run.policy).set("realtime", run.realtime);
  report.set("wakeups", static_cast<std::int64_t>(run.ticks));
  setSpread("late_us", "late", run.late_us, report);
  setSpread("bare_late_us", "late, bare timer", run.bare_late_us, report);
  setSpread("round_us", "round trip", run.round_us, report);
  setSpread("bare_round_us", "round trip, bare timer", run.bare_round_us, report);
  setSpread("age_us", "age of what is felt", run.age_us, report);
  for (const auto& [key, count] : {std::pair{"missed", run.missed},
                                   {"turns", run.round_trips},
                                   {"faults", run.faults},
                                   {"by_injection", run.causes.injected},
                                   {"by_delay", run.causes.delayed},
                                   {"unexplained", run.causes.unexplained},
                                   {"injected", run.injected},
                                   {"unnoticed", run.undetected_faults},
                                   {"overruns", run.overruns},
                                   {"uncounted", run.uncounted},
                                   {"stale", run.outdated_states}})
    report.set(key, static_cast<std::int64_t>(count));
  report.set("load", load, rounded(load));
  return console.report(
      report,
      run.outdated_states + run.undetected_faults + run.uncounted + run.causes.unexplained == 0
          ? kDone
          : kNotSolved);
}

// Runs a listed device whose hand touches the plane through the middle of its workspace.
int runOnDevice(const LatencyOptions& options, double load, Console& console) {
  const DeviceEntry& entry = deviceNamed(options.device);
  DeviceSetup setup;
  setup.name = options.device;
  setup.target = std::make_shared<TipTarget>(Vec3(0, 0, -2e-3));
  setup.model = entry.model;
  ServoLoop loop(openDevice(entry, setup, mountAt(entry, Vec3::Zero())), options.rate);
  HapticProperties haptics;
  haptics.stiffness = 500;
  loop.publish(planeSnapshot(haptics, {}));
  loop.start();
  const auto begin = std::chrono::steady_clock::now();
  std::vector<double> late;
  double t = 0;
  while (t < options.seconds && !console.progress().cancelled()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    t = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    console.progress().report(std::min(t / options.seconds, 1.0), "turning with the device");
    for (ToolSample sample; loop.samples().pop(sample);) late.push_back(1e-3 * sample.late_ns);
  }
  const std::string held = entry.linked ? inhibitText(*setup.notes) : "";
  loop.stop();
  if (console.progress().cancelled()) throw Cancelled();
  if (entry.linked && setup.notes->connect_count == 0)
    throw DeviceError(setup.notes->cause().empty() ? options.device + " did not answer in time"
                                                   : setup.notes->cause());
  const ServoTiming timing = loop.timing();
  Report report(kLatencyTestKeys);
  report.set("policy", timing.policy).set("realtime", timing.realtime);
  report.set("wakeups", static_cast<std::int64_t>(timing.ticks));
  report.set("rate_hz", timing.rate_hz);
  setSpread("late_us", "late", percentiles(std::move(late)), report);
  if (entry.linked) {
    const Percentiles round = setup.notes->round_trip.late();
    setSpread("round_us", "round trip",
              {1e-3 * round.p50, 1e-3 * round.p99, 1e-3 * round.p999, 1e-3 * round.max}, report);
    for (const auto& [key, count] : {std::pair{"turns", setup.notes->round_trips.load()},
                                     {"faults", setup.notes->faults.load()},
                                     {"overruns", setup.notes->overruns.load()},
                                     {"openings", setup.notes->connect_count.load()}})
      report.set(key, static_cast<std::int64_t>(count));
    report.set("held", held);
  }
  report.set("missed", static_cast<std::int64_t>(timing.missed)).set("load", load, rounded(load));
  return console.report(report);
}

int runLatencyTest(const LatencyOptions& options, Console& console) {
  double load = 0;
  if (getloadavg(&load, 1) != 1) load = 0;
  if (options.wire)
    console.warnOfNoEffect({"--device", "--rate"}, "with --emulated-falcon");
  else
    console.warnOfNoEffect({"--load", "--faults"}, "without --emulated-falcon");
  if (options.wire) return runOnWire(options, load, console);
  if (!options.device.empty()) return runOnDevice(options, load, console);
  console.endOnInterrupt();
  const Latency latency = measureLatency(options.seconds, options.rate);

  Report report(kLatencyTestKeys);
  report.set("policy", latency.policy).set("realtime", latency.realtime);
  report.set("wakeups", static_cast<std::int64_t>(latency.wakeups),
             formatCount(latency.wakeups) + " at " + formatNumber(options.rate) + " Hz");
  report.set("rate_hz", latency.rate_hz);
  setSpread("late_us", "late", latency.late_us, report);
  if (latency.wait_us)
    setSpread("wait_us", "of it waiting for a processor", *latency.wait_us, report);
  report.set("missed", static_cast<std::int64_t>(latency.missed)).set("load", load, rounded(load));
  return console.report(report);
}

} // namespace

Command latencyTestCommand() {
  auto options = std::make_shared<LatencyOptions>();
  return {
      .name = "latency-test",
      .summary = "how late this machine wakes a 1 kHz thread",
      .description =
          "Runs the servo's own clock without device or scene and reports how late its wake-ups "
          "were. Run it under the load of your experiment. policy shows whether the system granted "
          "real-time priority. The kernel reports the part of the latency spent waiting for a busy "
          "processor; the rest comes from the timer or, in a virtual machine, from the host, and "
          "does not depend on priority.\n"
          "With --device the servo runs with a device, on a plane through the middle of its "
          "workspace, and the round trips to it are timed: hold the device's handle.\n"
          "With --emulated-falcon servo and driver run with an emulated Falcon, and a bare timer "
          "of the same "
          "priority with another. Every rendered position is compared with the emulated handle's; "
          "one that is older than stated ends the command with 1, as do an undetected fault, a "
          "fault "
          "that is neither injected nor due to a delay of this machine, and a period that is "
          "neither a tick nor counted as missed.",
      .examples = {"patina latency-test --seconds 60",
                   "patina latency-test --device falcon --seconds 20",
                   "patina latency-test --emulated-falcon --seconds 600 --load 2 --faults 5"},
      .keys = kLatencyTestKeys,
      .arguments =
          {{"--seconds", "T", "s", "5", "How long, up to 3600.",
            numberInto(1e-3, 3600, options->seconds)},
           {"--device", "NAME", "", "", "With this device, as the key device of a scene has it.",
            [options](const std::string& name) { options->device = (deviceNamed(name), name); }},
           {"--emulated-falcon", "", "", "", "With an emulated Falcon, at 1000 Hz.",
            into(options->wire)},
           {"--load", "N", "threads", "0", "With --emulated-falcon: that only take time.",
            inRange(
                0, 64, [options](double n) { options->on_wire.load = static_cast<int>(n); },
                NumberKind::whole)},
           {"--faults", "N", "", "0", "With --emulated-falcon: corrupted answers per thousand.",
            inRange(
                0, 1000,
                [options](double n) {
                  options->on_wire.faults_per_thousand = static_cast<unsigned>(n);
                },
                NumberKind::whole)},
           {"--rate", "HZ", "Hz", "1000", "Wake-ups a second, 100 to 10000.",
            numberInto(100, 10000, options->rate)}},
      .run = [options](Console& console) { return runLatencyTest(*options, console); }};
}

} // namespace patina::cli
