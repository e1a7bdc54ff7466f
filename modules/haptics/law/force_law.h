// Stages that compute the force from the contact point, after contact and friction.
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/law/painted_range.h"
#include "haptics/law/snapshot.h"

namespace patina {

// Adds spring, magnet, velocity filter and damping of `haptics`, or the plan's coupling instead;
// then the plan's passivity controller and the limit. magnet: stage of `haptics`, no stiffer than
// the coupling, or null. max_speed: v_max of the jump fault [m/s]. slopes: sampler for the gradient
// of conservative painted stiffness, or null. Stores the plan in the snapshot.
void addForceLaw(HapticSnapshot& snapshot, const HapticProperties& haptics,
                 const PaintedRange& range, StabiliserPlan plan,
                 std::unique_ptr<const ForceStage> magnet, double max_speed,
                 const FieldSampler* slopes);

} // namespace patina
