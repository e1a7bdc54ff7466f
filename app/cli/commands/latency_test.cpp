#include <cstdlib>

#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/servo/latency.h"

namespace patina::cli {

namespace {

struct LatencyOptions {
  std::optional<double> seconds = 5;
  std::optional<double> rate = 1000;
};

void addSpread(TextRows& rows, const std::string& name, const Percentiles& us) {
  for (const auto& [percentile, value] :
       {std::pair{"p50", us.p50}, {"p99", us.p99}, {"p99.9", us.p999}, {"max", us.max}})
    rows.emplace_back(name + ", " + percentile, rounded(value) + " us");
}

int runLatencyTest(const LatencyOptions& options, Console& console) {
  if (!(*options.seconds > 0) || *options.seconds > 3600)
    throw Error("--seconds: between 0 and 3600, not " + formatNumber(*options.seconds));
  if (*options.rate < 100 || *options.rate > 10000)
    throw Error("--rate: between 100 and 10000 Hz, not " + formatNumber(*options.rate));
  double load = 0;
  if (getloadavg(&load, 1) != 1) load = 0;
  console.endOnInterrupt();
  const Latency latency = measureLatency(*options.seconds, *options.rate);

  Json json = Json::object();
  json.set("policy", latency.policy);
  json.set("realtime", latency.realtime);
  json.set("wakeups", static_cast<std::int64_t>(latency.wakeups));
  json.set("rate_hz", latency.rate_hz);
  json.set("late_us", toJson(latency.late_us));
  if (latency.wait_us) json.set("wait_us", toJson(*latency.wait_us));
  json.set("missed", static_cast<std::int64_t>(latency.missed));
  json.set("load", load);
  TextRows rows{
      {"policy", latency.policy},
      {"wake-ups", formatCount(latency.wakeups) + " at " + formatNumber(*options.rate) + " Hz"}};
  addSpread(rows, "late", latency.late_us);
  if (latency.wait_us) addSpread(rows, "of it waiting for a processor", *latency.wait_us);
  rows.emplace_back("missed", formatCount(latency.missed));
  rows.emplace_back("load", rounded(load));
  console.report(json, aligned(rows));
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
      "the system granted real-time priority. Of the lateness, the kernel tells what was waiting "
      "for a processor that something else had; the rest is the timer's or, in a virtual machine, "
      "the host's, and no priority helps against it.\n"
      "JSON: policy, realtime, wakeups, rate_hz, late_us (p50, p99, p999, max), wait_us (the same, "
      "of the wait for a processor; absent where the kernel does not count it), missed (wake-ups "
      "more than a period late), load (1-minute average at the start).";
  command.examples = {"patina latency-test --seconds 60"};
  command.number("--seconds", "T", "How long [s].", options->seconds);
  command.number("--rate", "HZ", "Wake-ups a second, 100 to 10000.", options->rate);
  command.run = [options](Console& console) { return runLatencyTest(*options, console); };
  return command;
}

} // namespace patina::cli
