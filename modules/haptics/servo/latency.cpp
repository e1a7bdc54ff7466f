#include "haptics/servo/latency.h"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <vector>

#include "haptics/device/realtime.h"
#include "haptics/servo/run_delay.h"

namespace patina {
namespace {

constexpr double kUsPerNs = 1e-3;

struct Wakeups {
  explicit Wakeups(std::size_t count) : late_us(count), wait_us(count) {}
  std::vector<double> late_us, wait_us; // allocated in advance
  bool wait_known = true;
  RealtimeGrant grant;
  std::int64_t missed = 0;
  std::int64_t elapsed_ns = 0;
};

void wakeUp(Wakeups& wakeups, std::int64_t period_ns) noexcept {
  wakeups.grant = requestRealtime();
  const RunDelay wait;
  std::int64_t waited = wait.total().value_or(0);
  const std::int64_t start = monotonicNs();
  PeriodicClock clock(start, period_ns);
  for (std::size_t i = 0; i < wakeups.late_us.size(); ++i) {
    const std::int64_t deadline = clock.nextDeadline();
    sleepUntil(deadline);
    const std::int64_t woke = monotonicNs();
    wakeups.missed += clock.woke(woke);
    wakeups.late_us[i] = kUsPerNs * static_cast<double>(std::max<std::int64_t>(woke - deadline, 0));
    const std::optional<std::int64_t> total = wait.total();
    wakeups.wait_known = wakeups.wait_known && total;
    wakeups.wait_us[i] = kUsPerNs * static_cast<double>(total.value_or(waited) - waited);
    waited = total.value_or(waited);
  }
  wakeups.elapsed_ns = monotonicNs() - start;
}

} // namespace

Latency measureLatency(double seconds, double rate_hz) {
  const std::int64_t period_ns = periodNs(rate_hz);
  if (!(seconds > 0 && seconds <= 3600))
    throw std::invalid_argument("latency measurement takes more than 0 and at most 3600 s");
  const double count = std::max(1.0, seconds * rate_hz);
  Wakeups wakeups(static_cast<std::size_t>(count));
  std::thread thread([&] { wakeUp(wakeups, period_ns); });
  thread.join();

  Latency latency;
  latency.policy = policyText(wakeups.grant);
  latency.realtime = wakeups.grant.fifo_error == 0;
  latency.wakeups = wakeups.late_us.size();
  latency.missed = static_cast<std::uint64_t>(wakeups.missed);
  latency.rate_hz =
      static_cast<double>(latency.wakeups) / (1e-9 * static_cast<double>(wakeups.elapsed_ns));
  latency.late_us = percentiles(wakeups.late_us);
  if (wakeups.wait_known) {
    latency.wait_us = percentiles(wakeups.wait_us);
    for (std::size_t i = 0; i < wakeups.late_us.size(); ++i)
      wakeups.late_us[i] = std::max(0.0, wakeups.late_us[i] - wakeups.wait_us[i]);
    latency.timer_us = percentiles(std::move(wakeups.late_us));
  }
  return latency;
}

} // namespace patina
