// Where a simulated tip begins on a model.
#pragma once

#include "session/build/session.h"

namespace patina::cli {

struct SimulationStart {
  Vec3 surface = Vec3::Zero(); // [m], world: where the tip's centre first touches
  Vec3 inward = Vec3::Zero();  // unit
};

// Straight below the middle of the top (+z) of the model's box; where nothing is below, as over the
// hole of a ring, the nearest point of the model to that middle. Offset and tip radius included.
// Throws Error where the field has no direction there.
SimulationStart simulationStart(const CompiledScene& compiled);

} // namespace patina::cli
