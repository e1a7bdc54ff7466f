#include "haptics/stages/limit_stage.h"

#include <algorithm>
#include <cmath>

namespace patina {

void LimitStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const bool finite = contact.force.allFinite();
  const Vec3 raw = finite ? contact.force : Vec3::Zero();
  if (!finite || jumped(contact, memory)) {
    memory.faulted = true;
    memory.since_fault = 0;
    memory.fault_force = memory.has_last_raw ? memory.applied : Vec3::Zero();
    memory.has_stuck = false; // a stuck point does not outlive the jump
  }
  memory.last_raw = raw;
  memory.last_stiffness = contact.stiffness;
  memory.has_last_raw = true;
  contact.force = scaledTo(raw, spec_.force_limit);
  if (!memory.faulted) return;
  contact.fault = true;
  memory.since_fault += std::max(contact.dt, 0.0);
  const double left = memory.since_fault - kFaultFadeTime;
  if (left < 0) {
    contact.force = -left / kFaultFadeTime * memory.fault_force;
  } else if (left < kFaultReturnTime && (contact.touching || contact.attracted)) {
    contact.force *= left / kFaultReturnTime;
  } else {
    memory.faulted = false;
  }
}

bool LimitStage::jumped(const Contact& contact, const ContactMemory& memory) const noexcept {
  if (!memory.has_last_raw) return false;
  const double period = std::clamp(contact.dt, 1e-4, 0.05);
  const double stiffness = std::max({contact.stiffness, memory.last_stiffness, spec_.pull});
  const double per_speed = 2 * (stiffness * period + spec_.damping);
  const double cap = std::max(spec_.force_limit, kHandSpeed * per_speed);
  const double allowed =
      std::min(spec_.max_speed * per_speed, cap) + stiffness * contact.slip_step +
      (stiffness + spec_.damping / period) * contact.relief_step + contact.known_step;
  return (contact.force - memory.last_raw).squaredNorm() > allowed * allowed;
}

Vec3 scaledTo(const Vec3& force, double limit) noexcept {
  limit *= 1 - 1e-15; // rounding of the scaled vector must not lift it over the limit
  if (force.squaredNorm() <= limit * limit) return force;
  return limit / force.stableNorm() * force; // the square may have overflowed
}

} // namespace patina
