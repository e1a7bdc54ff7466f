#include <cstdlib>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/numbers.h"
#include "haptics/servo/latency.h"

namespace patina::cli {

namespace {

struct LatencyOptions {
  double seconds = 5, rate = 1000;
};

const Keys kLatencyTestKeys = {{"policy", "", "policy", "what the system granted"},
                               {"realtime", "", "real time", "", Shown::never},
                               {"wakeups", "", "wake-ups"},
                               {"rate_hz", "Hz", "rate", "", Shown::never},
                               {"late_us", "us", "late", "", Shown::never, percentileParts()},
                               {"wait_us", "us", "of it waiting for a processor",
                                "absent where the kernel does not count it", Shown::never,
                                percentileParts()},
                               {"missed", "", "missed", "wake-ups more than a period late"},
                               {"load", "", "load", "1-minute average at the start"}};

void setSpread(const char* key, const std::string& caption, const Percentiles& us, Report& report) {
  report.set(key, toJson(us));
  for (const auto& [percentile, value] :
       {std::pair{"p50", us.p50}, {"p99", us.p99}, {"p99.9", us.p999}, {"max", us.max}})
    report.tell(caption + ", " + percentile, shown(value, "us"));
}

int runLatencyTest(const LatencyOptions& options, Console& console) {
  double load = 0;
  if (getloadavg(&load, 1) != 1) load = 0;
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
  return {.name = "latency-test",
          .summary = "how late this machine wakes a 1 kHz thread",
          .description =
              "Runs the servo's own clock without device or scene and reports how late its "
              "wake-ups were. Run it while the machine does what it will do during your "
              "experiment. policy says whether the system granted real-time priority. Of the "
              "lateness, the kernel tells what was waiting for a processor that something else "
              "had; the rest is the timer's or, in a virtual machine, the host's, and no priority "
              "helps against it.",
          .examples = {"patina latency-test --seconds 60"},
          .keys = kLatencyTestKeys,
          .arguments = {{"--seconds", "T", "s", "5", "How long, up to 3600.",
                         inRange(1e-3, 3600, [options](double s) { options->seconds = s; })},
                        {"--rate", "HZ", "Hz", "1000", "Wake-ups a second, 100 to 10000.",
                         inRange(100, 10000, [options](double hz) { options->rate = hz; })}},
          .run = [options](Console& console) { return runLatencyTest(*options, console); }};
}

} // namespace patina::cli
