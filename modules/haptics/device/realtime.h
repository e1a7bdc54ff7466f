// Clock and scheduling of a periodic thread.
#pragma once

#include <cstdint>
#include <string>

namespace patina {

std::int64_t monotonicNs() noexcept;
// Throws std::invalid_argument for a rate outside 100 .. 10000 Hz.
std::int64_t periodNs(double rate_hz);
void sleepUntil(std::int64_t monotonic_ns) noexcept; // absolute time; signals do not end the sleep

struct RealtimeGrant {
  int fifo_error = 0; // errno of a refusal; 0: granted, -1: not requested yet
  int lock_error = 0;
};
// Text for the status bar: the policy, or the refusals and their reasons.
std::string policyText(const RealtimeGrant& grant);
// For the calling thread: SCHED_FIFO 50, memory locked on first access, smallest timer slack,
// prefaulted stack. Continues after a refusal and returns it.
RealtimeGrant requestRealtime() noexcept;

// Deadlines one period apart; counts and skips missed ones, so that ticks never come in bursts.
class PeriodicClock {
 public:
  PeriodicClock(std::int64_t start_ns, std::int64_t period_ns) noexcept
      : deadline_(start_ns), period_(period_ns) {}

  std::int64_t nextDeadline() noexcept { return deadline_ += period_; }
  // woke_ns: wake-up time. Returns the number of whole periods that were missed.
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
