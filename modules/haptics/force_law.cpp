#include "haptics/force_law.h"

#include <algorithm>

#include "core/numbers.h"
#include "haptics/coupling_stage.h"
#include "haptics/limit_stage.h"
#include "haptics/material_stage.h"
#include "haptics/spring_stage.h"

namespace patina {

void addStage(HapticSnapshot& snapshot, std::unique_ptr<const ForceStage> stage, std::string why,
              std::size_t bytes) {
  snapshot.why.push_back({std::string(stage->name()), std::move(why), bytes});
  snapshot.stages.push_back(std::move(stage));
}

void addForceLaw(HapticSnapshot& snapshot, const HapticProperties& haptics,
                 const PaintedRange& range, StabiliserPlan plan, const MagnetMaker& magnet,
                 double max_speed, bool slopes) {
  const auto add = [&](std::unique_ptr<const ForceStage> stage, std::string why) {
    addStage(snapshot, std::move(stage), std::move(why));
  };
  const auto says = [](const char* key, double value) {
    return key + (" = " + formatNumber(value));
  };
  const auto soft = [&](double stiffness) {
    return plan.coupling ? inSeries(stiffness, plan.coupling->stiffness) : stiffness;
  };
  const bool pulls = haptics.magnet && haptics.magnet->range * haptics.magnet->strength > 0;
  const auto addMagnet = [&] {
    if (!haptics.magnet) return;
    Magnet softened = *haptics.magnet;
    softened.strength = soft(softened.strength);
    add(magnet(softened), says("magnet.range", softened.range));
  };

  LimitSpec limit{haptics.force_limit, haptics.magnet ? soft(haptics.magnet->strength) : 0.0,
                  range.most.damping, max_speed};
  if (plan.coupling) {
    const CouplingPlan& coupling = *plan.coupling;
    addMagnet();
    limit.damping = std::max(coupling.damping, std::min(range.most.damping, coupling.most_damping));
    add(std::make_unique<CouplingStage>(coupling.stiffness, coupling.damping, coupling.most_damping,
                                        pulls),
        plan.why);
  } else {
    add(std::make_unique<SpringStage>(), says("stiffness", haptics.stiffness));
    addMagnet();
    const bool painted = range.has(MaterialChannel::damping);
    if (haptics.damping_cutoff && (haptics.damping || painted))
      add(std::make_unique<VelocityFilterStage>(*haptics.damping_cutoff),
          says("damping.cutoff", *haptics.damping_cutoff));
    if (haptics.damping || painted)
      add(std::make_unique<DampingStage>(pulls),
          painted ? "damping is painted" : says("damping", *haptics.damping));
  }
  if (slopes) add(std::make_unique<StiffnessSlopeStage>(), "material.force = conservative");
  if (plan.passivity) add(std::make_unique<PassivityStage>(*plan.passivity), plan.why);
  add(std::make_unique<LimitStage>(limit), "always");
  snapshot.stabilisers = std::move(plan);
}

} // namespace patina
