#include "haptics/limit_stage.h"

#include <algorithm>
#include <cmath>

namespace patina {

void LimitStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const bool finite = contact.force.allFinite();
  const Vec3 raw = finite ? contact.force : Vec3::Zero();
  if (!memory.faulted && (!finite || jumped(contact, memory))) {
    memory.faulted = true;
    memory.fade = 1;
    memory.fault_force = limited(memory.last_raw);
    memory.leaveContact(); // a held or stuck point does not outlive the jump
  }
  memory.last_raw = raw;
  memory.has_last_raw = true;
  if (!memory.faulted) {
    contact.force = limited(raw);
    return;
  }
  contact.fault = true;
  memory.fade = std::max(0.0, memory.fade - std::max(contact.dt, 0.0) / kFaultFadeTime);
  contact.force = memory.fade * memory.fault_force;
  if (memory.fade == 0 && !contact.touching) {
    memory.faulted = false;
    memory.fade = 1;
  }
}

bool LimitStage::jumped(const Contact& contact, const ContactMemory& memory) const noexcept {
  if (!memory.has_last_raw) return false;
  const double period = std::clamp(contact.dt, 1e-4, 0.05);
  const double per_speed = 2 * (spec_.stiffness * period + spec_.damping);
  const double cap = std::max(spec_.force_limit, kHandSpeed * per_speed);
  const double allowed =
      std::min(spec_.max_speed * per_speed, cap) + spec_.stiffness * contact.slip_step +
      (spec_.stiffness + spec_.damping / period) * contact.relief_step + contact.known_step;
  return (contact.force - memory.last_raw).squaredNorm() > allowed * allowed;
}

Vec3 LimitStage::limited(const Vec3& force) const noexcept {
  // Rounding of the scaled vector must not lift it over the limit.
  const double limit = spec_.force_limit * (1 - 1e-15);
  if (force.squaredNorm() <= limit * limit) return force;
  return limit / force.stableNorm() * force; // the square may have overflowed
}

} // namespace patina
