#include "haptics/law/force_law.h"

#include <algorithm>

#include "core/numbers.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/limit_stage.h"
#include "haptics/law/material_stage.h"
#include "haptics/law/spring_stage.h"

namespace patina {

void addForceLaw(HapticSnapshot& snapshot, const HapticProperties& haptics,
                 const PaintedRange& range, StabiliserPlan plan,
                 std::unique_ptr<const ForceStage> magnet, double max_speed,
                 const FieldSampler* slopes) {
  const auto says = [](const char* key, double value) {
    return key + (" = " + formatNumber(value));
  };
  const bool pulls = magnet != nullptr;
  const auto addMagnet = [&] {
    if (pulls)
      snapshot.add("magnet", std::move(magnet), says("magnet.range", haptics.magnet->range));
  };

  LimitSpec limit{haptics.force_limit, pulls ? haptics.magnet->strength : 0.0, range.max.damping,
                  max_speed};
  if (plan.coupling) {
    const CouplingPlan& coupling = *plan.coupling;
    addMagnet();
    limit.damping = std::max(coupling.damping, std::min(range.max.damping, coupling.max_damping));
    snapshot.add("coupling", std::make_unique<CouplingStage>(coupling, pulls), plan.why);
  } else {
    snapshot.add("spring", std::make_unique<SpringStage>(), says("stiffness", haptics.stiffness));
    addMagnet();
    const bool painted = range.has(MaterialChannel::damping);
    if (haptics.damping_cutoff && (haptics.damping || painted))
      snapshot.add("velocity filter",
                   std::make_unique<VelocityFilterStage>(*haptics.damping_cutoff),
                   says("damping.cutoff", *haptics.damping_cutoff));
    if (haptics.damping || painted)
      snapshot.add("damping", std::make_unique<DampingStage>(pulls),
                   painted ? "damping is painted" : says("damping", *haptics.damping));
  }
  if (slopes)
    snapshot.add("stiffness slope", std::make_unique<StiffnessGradientStage>(*slopes),
                 "material.force = conservative");
  if (plan.passivity)
    snapshot.add("passivity", std::make_unique<PassivityStage>(*plan.passivity), plan.why);
  snapshot.add("limit", std::make_unique<LimitStage>(limit), "always");
  snapshot.stabilisers = std::move(plan);
}

} // namespace patina
