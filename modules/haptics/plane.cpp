#include "haptics/plane.h"

#include <stdexcept>

#include "core/numbers.h"
#include "haptics/coupling_stage.h"
#include "haptics/limit_stage.h"
#include "haptics/spring_stage.h"

namespace patina {

void PlaneStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double depth = -contact.tip.z();
  if (!(depth > 0)) {
    memory.leaveContact();
    return;
  }
  contact.touching = true;
  contact.normal = Vec3::UnitZ();
  contact.depth = depth;
  contact.candidate = Vec3(contact.tip.x(), contact.tip.y(), 0);
  contact.vcp = contact.candidate;
  memory.in_contact = true;
  memory.last_normal = contact.normal;
  memory.last_candidate = contact.candidate;
}

std::shared_ptr<const HapticSnapshot> planeSnapshot(const HapticProperties& haptics,
                                                    const StabiliserPlan& plan) {
  if (haptics.friction || haptics.offset || haptics.magnet || haptics.tip_radius)
    throw std::invalid_argument("plane: friction, offset, magnet and tip radius need a field");
  auto snapshot = std::make_shared<HapticSnapshot>();
  const auto add = [&](std::unique_ptr<const ForceStage> stage, std::string why) {
    snapshot->why.push_back({std::string(stage->name()), std::move(why), 0});
    snapshot->stages.push_back(std::move(stage));
  };
  LimitSpec limit{haptics.force_limit, haptics.stiffness, haptics.damping.value_or(0)};
  add(std::make_unique<PlaneStage>(), "always");
  if (plan.coupling) {
    const CouplingPlan& c = *plan.coupling;
    add(std::make_unique<CouplingStage>(haptics.stiffness, c.stiffness, c.damping), plan.why);
    limit.stiffness = inSeries(haptics.stiffness, c.stiffness);
    limit.damping = c.damping;
  } else {
    add(std::make_unique<SpringStage>(haptics.stiffness),
        "stiffness = " + formatNumber(haptics.stiffness));
    if (haptics.damping && haptics.damping_cutoff)
      add(std::make_unique<VelocityFilterStage>(*haptics.damping_cutoff),
          "damping.cutoff = " + formatNumber(*haptics.damping_cutoff));
    if (haptics.damping)
      add(std::make_unique<DampingStage>(*haptics.damping),
          "damping = " + formatNumber(*haptics.damping));
  }
  if (plan.passivity) {
    add(std::make_unique<PassivityStage>(*plan.passivity), plan.why);
    limit.damping += plan.passivity->most;
  }
  add(std::make_unique<LimitStage>(limit), "always");
  return snapshot;
}

} // namespace patina
