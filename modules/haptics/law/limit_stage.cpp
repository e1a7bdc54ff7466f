#include "haptics/law/limit_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/law/contact_memory.h"

namespace patina {

void LimitStage::apply(Contact& contact, ContactMemory& all) const noexcept {
  LimitMemory& memory = all.limit;
  const bool finite = contact.force.allFinite();
  const Vec3 raw = finite ? contact.force : Vec3::Zero();
  memory.jumped = !finite || jumped(contact, memory);
  if (memory.jumped)
    memory.fault = LimitMemory::Fault{memory.last ? all.tip.applied : Vec3::Zero(), 0};
  memory.last = LimitMemory::Raw{raw, contact.stiffness};
  contact.force = scaledTo(raw, spec_.force_limit);
  if (!memory.fault) return;
  contact.fault = true;
  memory.fault->since += std::max(contact.dt, 0.0);
  const double left = memory.fault->since - kFaultFadeTime;
  if (left < 0) {
    contact.force = -left / kFaultFadeTime * memory.fault->force;
  } else if (left < kFaultReturnTime && (contact.touching || contact.attracted)) {
    contact.force *= left / kFaultReturnTime;
  } else {
    memory.fault.reset();
  }
}

bool LimitStage::jumped(const Contact& contact, const LimitMemory& memory) const noexcept {
  if (!memory.last) return false;
  const double period = std::clamp(contact.dt, 1e-4, 0.05);
  const double stiffness = std::max({contact.stiffness, memory.last->stiffness, spec_.pull});
  const double per_speed = 2 * (stiffness * period + spec_.damping);
  const double cap = std::max(spec_.force_limit, kHandSpeed * per_speed);
  const double allowed =
      std::min(spec_.max_speed * per_speed, cap) + stiffness * contact.slip_jump +
      (stiffness + spec_.damping / period) * contact.relief_jump + contact.expected_force_jump;
  return (contact.force - memory.last->force).squaredNorm() > allowed * allowed;
}

Vec3 scaledTo(const Vec3& force, double limit) noexcept {
  limit *= 1 - 1e-15; // rounding must not exceed the limit
  if (force.squaredNorm() <= limit * limit) return force;
  return limit / force.stableNorm() * force; // the square may have overflowed
}

} // namespace patina
