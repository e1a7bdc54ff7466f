// Timing benchmark of servo, driver and an emulated Falcon, compared with a bare timer.
#pragma once

#include <cstdint>
#include <string>

#include "core/percentiles.h"
#include "core/progress.h"
#include "haptics/simulation/fault_tally.h"

namespace patina {

struct WireBenchmarkSpec {
  double seconds = 20;
  unsigned faults_per_thousand = 0; // per 1000 frames, over all kinds of wire fault
  int load = 0;                     // busy threads
  unsigned seed = 1;
};

struct WireBenchmark {
  std::string policy; // servo's scheduling policy
  bool realtime = false;
  std::uint64_t ticks = 0, missed = 0;       // servo's ticks and missed periods
  std::uint64_t uncounted = 0;               // periods that are neither, by the clock
  std::uint64_t round_trips = 0, faults = 0; // link's exchanges and faults
  FaultCauses causes;                        // they add up to the faults
  std::uint64_t overruns = 0;                // exchanges without a new command
  std::uint64_t injected = 0;                // injected faults
  std::uint64_t undetected_faults = 0;       // injected faults whose replies were accepted
  std::uint64_t outdated_states = 0;         // states with a position older than stated
  double max_error = 0;                      // largest position error of a state [m]
  Percentiles late_us, bare_late_us;         // wake-up latency
  Percentiles round_us, bare_round_us;       // from a frame to its reply, answered ones only
  Percentiles age_us;                        // age of the states that the servo used
};

// Runs in real time: the hand moves in circles through a plane, while the bare timer exchanges with
// its own Falcon under the same scheduling. Compares every state with the handle's position at the
// state's time. Throws std::invalid_argument unless seconds is from 0.1 to 36000, and Cancelled.
WireBenchmark runOnEmulatedWire(const WireBenchmarkSpec& spec, Progress& progress);

} // namespace patina
