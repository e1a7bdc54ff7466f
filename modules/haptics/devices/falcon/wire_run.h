// How steadily servo, driver and an emulated Falcon turn, beside a bare timer with the same device.
#pragma once

#include <cstdint>
#include <string>

#include "core/percentiles.h"
#include "core/progress.h"

namespace patina {

struct WireRunSpec {
  double seconds = 20;
  unsigned faults_per_thousand = 0; // frames; of each kind that the wire can have
  int load = 0;                     // threads that do nothing but take time
  unsigned seed = 1;
};

struct WireRun {
  std::string policy; // of the servo
  bool realtime = false;
  std::uint64_t ticks = 0, missed = 0; // of the servo; periods in which it had none
  std::uint64_t uncounted = 0;         // periods that are neither, by the clock
  std::uint64_t turns = 0, faults = 0; // of the link
  std::uint64_t overruns = 0;          // turns without a new command
  std::uint64_t injected = 0;          // faults that were asked for
  std::uint64_t unnoticed = 0;         // of them, whose answers were taken
  std::uint64_t aged = 0;              // states that the servo had for a second time
  std::uint64_t stale = 0;             // states of a place where the handle was before they say
  double worst = 0;                    // [m], the most that one was off
  Percentiles late_us, bare_late_us;   // wake-ups after their time
  Percentiles round_us, bare_round_us; // from a frame to its answer, of all that were answered
  Percentiles age_us;                  // of what the servo felt
};

// In real time: the hand draws circles through a plane that is felt, while the bare timer turns
// with a Falcon of its own, in the same scheduling. Every state that the servo feels is held
// against where the handle was at the time the state says. Throws std::invalid_argument unless
// seconds is from 0.1 to 36000, and Cancelled.
WireRun runOnEmulatedWire(const WireRunSpec& spec, Progress& progress);

} // namespace patina
