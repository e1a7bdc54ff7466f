#include "haptics/contact/plane.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptics/stages/force_law.h"
#include "haptics/stages/limit_stage.h"

namespace patina {
namespace {

// The VCP is straight above the tip (K06).
class PlaneStage final : public ForceStage {
 public:
  void apply(Contact& contact, ContactMemory& memory) const noexcept override {
    const double depth = -contact.tip.z();
    if (!(depth > 0)) {
      memory.contact.c.reset();
      return;
    }
    contact.touching = true;
    contact.normal = Vec3::UnitZ();
    contact.depth = depth;
    contact.candidate = Vec3(contact.tip.x(), contact.tip.y(), 0);
    contact.vcp = contact.candidate;
    contact.wall[0] = {contact.normal, depth};
    contact.walls = 1;
    if (memory.contact.c) contact.drawn = contact.candidate - *memory.contact.c;
    memory.contact.c = contact.candidate;
  }
};

} // namespace

std::shared_ptr<const HapticSnapshot> planeSnapshot(const HapticProperties& haptics,
                                                    const StabiliserPlan& plan) {
  if (haptics.friction || haptics.offset || haptics.magnet || haptics.tip_radius)
    throw std::invalid_argument("plane: friction, offset, magnet and tip radius need a field");
  auto snapshot = std::make_shared<HapticSnapshot>();
  snapshot->add("plane", std::make_unique<PlaneStage>(), "always");
  // Without a limit nothing is a fault: what is looked for is how the loop itself ends.
  const bool limited = std::isfinite(haptics.force_limit);
  snapshot->base = baseMaterial(haptics);
  addForceLaw(*snapshot, haptics, paintedRange(snapshot->base, {}), plan, nullptr,
              limited ? kHandSpeed : std::numeric_limits<double>::infinity(), nullptr);
  return snapshot;
}

} // namespace patina
