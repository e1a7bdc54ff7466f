#include "haptics/law/plane.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptics/law/force_law.h"
#include "haptics/law/limit_stage.h"

namespace patina {
namespace {

// The contact point is vertically above the tip (K06).
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
    contact.frictionless_point = Vec3(contact.tip.x(), contact.tip.y(), 0);
    contact.vcp = contact.frictionless_point;
    contact.wall[0] = {contact.normal, depth};
    contact.walls = 1;
    if (memory.contact.c) contact.displacement = contact.frictionless_point - *memory.contact.c;
    memory.contact.c = contact.frictionless_point;
  }
};

} // namespace

std::shared_ptr<const HapticSnapshot> planeSnapshot(const HapticProperties& haptics,
                                                    const StabiliserPlan& plan) {
  if (haptics.friction || haptics.offset || haptics.magnet || haptics.tip_radius)
    throw std::invalid_argument("plane: friction, offset, magnet and tip radius need a field");
  auto snapshot = std::make_shared<HapticSnapshot>();
  snapshot->add("plane", std::make_unique<PlaneStage>(), "always");
  // If there is no force limit, nothing is a fault, so that an unstable loop shows how it ends.
  const bool limited = std::isfinite(haptics.force_limit);
  snapshot->base = baseMaterial(haptics);
  addForceLaw(*snapshot, haptics, paintedRange(snapshot->base, {}), plan, nullptr,
              limited ? kHandSpeed : std::numeric_limits<double>::infinity(), nullptr);
  return snapshot;
}

} // namespace patina
