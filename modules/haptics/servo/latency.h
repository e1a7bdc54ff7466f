// Measures the wake-up latency of a periodic thread on this machine, without device or scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/percentiles.h"

namespace patina {

struct Latency {
  std::string policy; // see ServoTiming
  bool realtime = false;
  std::uint64_t wakeups = 0;
  std::uint64_t missed = 0; // deadlines missed by more than a period
  double rate_hz = 0;
  Percentiles late_us; // wake-up latency of all wake-ups
  // Run delay since the last wake-up; absent if the kernel does not count it.
  std::optional<Percentiles> wait_us;
  // Wake-up latency minus run delay: share of the timer or a virtual machine's host.
  std::optional<Percentiles> timer_us;
};

// Measures for `seconds` (0 .. 3600) in a thread with the servo's scheduling; rate in 100 .. 10000
// Hz. Throws std::invalid_argument.
Latency measureLatency(double seconds, double rate_hz = 1000);

} // namespace patina
