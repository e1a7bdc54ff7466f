// The clock and the scheduling of a periodic thread.
#pragma once

#include <cstdint>
#include <string>

namespace patina {

std::int64_t monotonicNs() noexcept;
// Throws std::invalid_argument outside 100 .. 10000 Hz.
std::int64_t periodNs(double rate_hz);
void sleepUntil(std::int64_t monotonic_ns) noexcept; // absolute; not woken early by signals

struct RealtimeGrant {
  int fifo_error = 0; // errno of what was refused; 0 = granted, -1 = not asked yet
  int lock_error = 0;
};
// What was granted, or what was refused and why, for the status bar.
std::string policyText(const RealtimeGrant& grant);
// For the calling thread: SCHED_FIFO 50, memory locked as it is touched, the least timer slack, and
// a stack that will not fault. Carries on where the system refuses, and says so.
RealtimeGrant requestRealtime() noexcept;

// Deadlines one period apart. After a late wake-up the missed ones are counted and skipped, so that
// the loop never runs a burst of ticks to catch up.
class PeriodicClock {
 public:
  PeriodicClock(std::int64_t start_ns, std::int64_t period_ns) noexcept
      : deadline_(start_ns), period_(period_ns) {}

  std::int64_t nextDeadline() noexcept { return deadline_ += period_; }
  // woke_ns: when the thread ran. Returns how many whole periods late it was.
  std::int64_t woke(std::int64_t woke_ns) noexcept {
    const std::int64_t missed = woke_ns > deadline_ ? (woke_ns - deadline_) / period_ : 0;
    deadline_ += missed * period_;
    return missed;
  }

 private:
  std::int64_t deadline_;
  std::int64_t period_;
};

} // namespace patina
