// How late this machine wakes a periodic thread, without device or scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/percentiles.h"

namespace patina {

struct Latency {
  std::string policy; // as in ServoTiming
  bool realtime = false;
  std::uint64_t wakeups = 0;
  std::uint64_t missed = 0; // deadlines that passed by more than a period
  double rate_hz = 0;
  Percentiles late_us; // of all wake-ups
  // Waiting for a processor since the wake-up before: what other programs and the scheduler took.
  // Absent where the system keeps no account of it.
  std::optional<Percentiles> wait_us;
  // Lateness without that wait, wake-up by wake-up: of the timer, or of a virtual machine's host.
  std::optional<Percentiles> timer_us;
};

// Asks for what the servo asks for, in a thread of its own; returns after `seconds` (0 .. 3600).
// rate in 100 .. 10000 Hz. Throws std::invalid_argument.
Latency measureLatency(double seconds, double rate_hz = 1000);

} // namespace patina
