#include <cstdlib>

#include "app/cli/commands.h"
#include "app/cli/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/servo_loop.h"

namespace patina::cli {

namespace {

struct LatencyOptions {
  std::optional<double> seconds = 5;
  std::optional<double> rate = 1000;
};

int runLatencyTest(const LatencyOptions& options, Console& console) {
  if (!(*options.seconds > 0) || *options.seconds > 3600)
    throw Error("--seconds: between 0 and 3600, not " + formatNumber(*options.seconds));
  if (*options.rate < 100 || *options.rate > 10000)
    throw Error("--rate: between 100 and 10000 Hz, not " + formatNumber(*options.rate));
  double load = 0;
  if (getloadavg(&load, 1) != 1) load = 0;
  console.endOnInterrupt();
  const ServoTiming timing = measureLatency(*options.seconds, *options.rate);

  Json late =
      toJson(Percentiles{timing.late_p50, timing.late_p99, timing.late_p999, timing.late_max});
  Json json = Json::object();
  json.set("policy", timing.policy);
  json.set("realtime", timing.realtime);
  json.set("wakeups", static_cast<std::int64_t>(timing.ticks));
  json.set("rate_hz", timing.rate_hz);
  json.set("late_us", late);
  json.set("missed", static_cast<std::int64_t>(timing.missed));
  json.set("load", load);
  const auto us = [](double value) { return rounded(value) + " us"; };
  console.report(json, aligned({{"policy", timing.policy},
                                {"wake-ups", formatCount(timing.ticks) + " at " +
                                                 formatNumber(*options.rate) + " Hz"},
                                {"late, p50", us(timing.late_p50)},
                                {"late, p99", us(timing.late_p99)},
                                {"late, p99.9", us(timing.late_p999)},
                                {"late, max", us(timing.late_max)},
                                {"missed", formatCount(timing.missed)},
                                {"load", rounded(load)}}));
  return kDone;
}

} // namespace

Command latencyTestCommand() {
  auto options = std::make_shared<LatencyOptions>();
  Command command;
  command.name = "latency-test";
  command.summary = "how late this machine wakes a 1 kHz thread";
  command.description =
      "Runs the servo's own clock without device or scene and reports how late its wake-ups were. "
      "Run it while the machine does what it will do during your experiment. policy says whether "
      "the system granted real-time priority.\n"
      "JSON: policy, realtime, wakeups, rate_hz, late_us (p50, p99, p999, max), missed (wake-ups "
      "more than a period late), load (1-minute average at the start).";
  command.examples = {"patina latency-test --seconds 60"};
  command.number("--seconds", "T", "How long [s].", options->seconds);
  command.number("--rate", "HZ", "Wake-ups a second, 100 to 10000.", options->rate);
  command.run = [options](Console& console) { return runLatencyTest(*options, console); };
  return command;
}

} // namespace patina::cli
