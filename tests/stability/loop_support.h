// The closed loop on the exact plane, for the tests of stability.
#pragma once

#include <limits>

#include "haptics/plane.h"
#include "haptics/simulation.h"

namespace patina {

struct Wall {
  double stiffness = 500;
  double damping = 0;
  std::optional<double> cutoff{};
  std::optional<Stabilisers> stabilisers = Stabilisers{}; // none; nullopt = automatic
};

inline HapticProperties propertiesOf(const Wall& wall) {
  HapticProperties haptics;
  haptics.stiffness = wall.stiffness;
  if (wall.damping > 0) haptics.damping = wall.damping;
  haptics.damping_cutoff = wall.cutoff;
  haptics.force_limit = std::numeric_limits<double>::infinity();
  return haptics;
}

inline SimulationReport runOn(const Wall& wall, const SimulationSpec& spec,
                              const RowSink& row = {}) {
  const HapticProperties haptics = propertiesOf(wall);
  Progress progress;
  const auto snapshot =
      planeSnapshot(haptics, planStabilisers(haptics, spec.device, wall.stabilisers));
  return simulate(*snapshot, spec, progress, row);
}

// Whether a small oscillation about a pressed equilibrium decays, from the trajectory alone: the
// tip never leaves the wall, so nothing but the loop itself decides.
inline bool decays(Wall wall, double stiffness, SimulationSpec spec) {
  wall.stiffness = stiffness;
  spec.depth = 1e-3;
  spec.press = stiffness * spec.depth;
  spec.speed = 1e-6 * std::sqrt(stiffness / spec.device.mass);
  const SimulationReport run = runOn(wall, spec);
  return run.rms_velocity < run.rms_early;
}

// The stiffness at which it stops decaying, between the two given.
inline double measuredLimit(const Wall& wall, const SimulationSpec& spec, double low, double high) {
  while (high - low > 1e-4 * high) {
    const double middle = 0.5 * (low + high);
    (decays(wall, middle, spec) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace patina
