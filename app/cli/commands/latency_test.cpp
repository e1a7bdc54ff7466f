#include <cstdlib>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/numbers.h"
#include "haptics/devices/falcon/wire_run.h"
#include "haptics/servo/latency.h"

namespace patina::cli {

namespace {

struct LatencyOptions {
  double seconds = 5, rate = 1000;
  bool wire = false;
  WireRunSpec on_wire;
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
    {"bare_late_us", "us", "late, bare timer", "with --wire, as those below", Shown::never,
     percentileParts()},
    {"round_us", "us", "round trip", "", Shown::never, percentileParts()},
    {"bare_round_us", "us", "round trip, bare timer", "", Shown::never, percentileParts()},
    {"age_us", "us", "age of what is felt", "", Shown::never, percentileParts()},
    {"turns", "", "round trips answered"},
    {"faults", "", "faults noticed"},
    {"injected", "", "of them on purpose"},
    {"unnoticed", "", "of these, not noticed"},
    {"overruns", "", "round trips without a new command"},
    {"uncounted", "", "periods neither ticked nor missed"},
    {"stale", "", "old places felt as new"},
    {"load", "", "load", "1-minute average at the start"}};

void setSpread(const char* key, const std::string& caption, const Percentiles& us, Report& report) {
  report.set(key, toJson(us));
  for (const auto& [percentile, value] :
       {std::pair{"p50", us.p50}, {"p99", us.p99}, {"p99.9", us.p999}, {"max", us.max}})
    report.tell(caption + ", " + percentile, shown(value, "us"));
}

// Servo, driver and an emulated Falcon, beside a bare timer with another.
int runOnWire(const LatencyOptions& options, double load, Console& console) {
  WireRunSpec spec = options.on_wire;
  spec.seconds = options.seconds;
  const WireRun run = runOnEmulatedWire(spec, console.progress());
  Report report(kLatencyTestKeys);
  report.set("policy", run.policy).set("realtime", run.realtime);
  report.set("wakeups", static_cast<std::int64_t>(run.ticks));
  setSpread("late_us", "late", run.late_us, report);
  setSpread("bare_late_us", "late, bare timer", run.bare_late_us, report);
  setSpread("round_us", "round trip", run.round_us, report);
  setSpread("bare_round_us", "round trip, bare timer", run.bare_round_us, report);
  setSpread("age_us", "age of what is felt", run.age_us, report);
  for (const auto& [key, count] : {std::pair{"missed", run.missed},
                                   {"turns", run.turns},
                                   {"faults", run.faults},
                                   {"injected", run.injected},
                                   {"unnoticed", run.unnoticed},
                                   {"overruns", run.overruns},
                                   {"uncounted", run.uncounted},
                                   {"stale", run.stale}})
    report.set(key, static_cast<std::int64_t>(count));
  report.set("load", load, rounded(load));
  console.report(report);
  return run.stale + run.unnoticed + run.uncounted == 0 ? kDone : kNotSolved;
}

int runLatencyTest(const LatencyOptions& options, Console& console) {
  double load = 0;
  if (getloadavg(&load, 1) != 1) load = 0;
  if (options.wire) return runOnWire(options, load, console);
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
  console.report(report);
  return kDone;
}

} // namespace

Command latencyTestCommand() {
  auto options = std::make_shared<LatencyOptions>();
  return {
      .name = "latency-test",
      .summary = "how late this machine wakes a 1 kHz thread",
      .description =
          "Runs the servo's own clock without device or scene and reports how late its "
          "wake-ups were. Run it while the machine does what it will do during your "
          "experiment. policy says whether the system granted real-time priority. Of the "
          "lateness, the kernel tells what was waiting for a processor that something else "
          "had; the rest is the timer's or, in a virtual machine, the host's, and no priority "
          "helps against it.\n"
          "With --wire servo and driver turn with an emulated Falcon, while a bare timer of the "
          "same priority does with another. Every place that is felt is held against where the "
          "emulated handle was; one that is older than it says ends the command with 1, as do a "
          "fault that was not noticed and a period of the clock that is neither a tick nor missed.",
      .examples = {"patina latency-test --seconds 60",
                   "patina latency-test --wire --seconds 600 --load 2 --faults 5"},
      .keys = kLatencyTestKeys,
      .arguments =
          {{"--seconds", "T", "s", "5", "How long, up to 3600.",
            inRange(1e-3, 3600, [options](double s) { options->seconds = s; })},
           {"--wire", "", "", "", "With an emulated Falcon, at 1000 Hz.", into(options->wire)},
           {"--load", "N", "threads", "0", "With --wire: that only take time.",
            inRange(
                0, 64, [options](double n) { options->on_wire.load = static_cast<int>(n); },
                NumberKind::whole)},
           {"--faults", "N", "", "0", "With --wire: of a thousand answers, so many are spoilt.",
            inRange(
                0, 1000,
                [options](double n) {
                  options->on_wire.faults_per_thousand = static_cast<unsigned>(n);
                },
                NumberKind::whole)},
           {"--rate", "HZ", "Hz", "1000", "Wake-ups a second, 100 to 10000.",
            inRange(100, 10000, [options](double hz) { options->rate = hz; })}},
      .run = [options](Console& console) { return runLatencyTest(*options, console); }};
}

} // namespace patina::cli
