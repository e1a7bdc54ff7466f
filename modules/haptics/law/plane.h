// The exact plane z = 0, solid below, without a grid and thus without a depth limit.
#pragma once

#include <memory>

#include "haptics/law/snapshot.h"
#include "haptics/law/stabilisers.h"

namespace patina {

// Spring, damping, stabilisers and limit of compileStages(), on the plane. The snapshot has no
// field. Throws std::invalid_argument for friction, offset, magnet or tip radius, which need one.
// With an infinite force limit no jump is a fault.
std::shared_ptr<const HapticSnapshot> planeSnapshot(const HapticProperties& haptics,
                                                    const StabiliserPlan& plan);

} // namespace patina
