// The closed loop on the exact plane, for the tests of stability.
#pragma once

#include <limits>

#include "app/studies/haptics/measured_limit.h"
#include "haptics/law/plane.h"
#include "haptics/simulation/simulation.h"

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

inline double measuredLimit(const Wall& wall, const SimulationSpec& spec, double low, double high) {
  return measuredStiffnessLimit(propertiesOf(wall), spec, low, high);
}

} // namespace patina
