// The simulated loop with the time it took.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

#include "haptics/devices/simulation.h"

namespace patina {

struct TimedRun {
  SimulationReport report;
  double seconds = 0; // wall, the least of three passes
  double ns = 0;      // of a tick, device included
};

inline TimedRun timedRun(const HapticSnapshot& snapshot, const SimulationSpec& spec) {
  using Clock = std::chrono::steady_clock;
  Progress progress;
  TimedRun run;
  run.seconds = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 3; ++pass) { // what else the machine does can only add
    const auto start = Clock::now();
    run.report = simulate(snapshot, spec, progress);
    const std::chrono::duration<double> taken = Clock::now() - start;
    run.seconds = std::min(run.seconds, taken.count());
  }
  run.ns = 1e9 * run.seconds / static_cast<double>(run.report.ticks);
  return run;
}

} // namespace patina
