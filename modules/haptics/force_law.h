// What turns the contact point into a force: the stages behind contact and friction.
#pragma once

#include <functional>

#include "haptics/painted_range.h"
#include "haptics/snapshot.h"

namespace patina {

using MagnetMaker = std::function<std::unique_ptr<const ForceStage>(const Magnet&)>;

// One more stage, with its reason.
void addStage(HapticSnapshot& snapshot, std::unique_ptr<const ForceStage> stage, std::string why,
              std::size_t bytes = 0);

// Spring, magnet, velocity filter and damping as `haptics` has them, or in their place the plan's
// coupling, behind which the magnet too is no stiffer than the coupling; then the plan's passivity
// controller, then the limit. max_speed: the jump fault's v_max [m/s]. slopes: painted stiffness is
// felt as a potential. Keeps the plan.
void addForceLaw(HapticSnapshot& snapshot, const HapticProperties& haptics,
                 const PaintedRange& range, StabiliserPlan plan, const MagnetMaker& magnet,
                 double max_speed, bool slopes);

} // namespace patina
