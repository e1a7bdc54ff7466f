// What turns the contact point into a force: the stages behind contact and friction.
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/servo/snapshot.h"
#include "haptics/stability/painted_range.h"

namespace patina {

// Spring, magnet, velocity filter and damping as `haptics` has them, or in their place the plan's
// coupling; then the plan's passivity controller, then the limit. magnet: that of `haptics`, made
// no stiffer than the coupling, or null. max_speed: the jump fault's v_max [m/s]. slopes: where
// painted stiffness is felt as a potential, what its surface is read by; else null. Keeps the plan.
void addForceLaw(HapticSnapshot& snapshot, const HapticProperties& haptics,
                 const PaintedRange& range, StabiliserPlan plan,
                 std::unique_ptr<const ForceStage> magnet, double max_speed,
                 const FieldSampler* slopes);

} // namespace patina
