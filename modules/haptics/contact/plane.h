// The exact plane z = 0, solid below: no grid, so that no depth is too deep.
#pragma once

#include <memory>

#include "haptics/servo/snapshot.h"
#include "haptics/stability/stabilisers.h"

namespace patina {

// Spring, damping, stabilisers and limit as compileStages() makes them, on the plane. Has no field.
// Throws std::invalid_argument for friction, offset, magnet or tip radius, which need one. An
// infinite force limit is allowed; then no jump of the force is a fault either.
std::shared_ptr<const HapticSnapshot> planeSnapshot(const HapticProperties& haptics,
                                                    const StabiliserPlan& plan);

} // namespace patina
