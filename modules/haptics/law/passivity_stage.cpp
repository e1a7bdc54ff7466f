#include "haptics/law/passivity_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/law/contact_memory.h"

namespace patina {

void PassivityStage::apply(Contact& contact, ContactMemory& all) const noexcept {
  PassivityMemory& memory = all.passivity;
  const std::optional<Vec3>& last_tip = all.tip.last;
  // The contact point on a relief slope is farther away than the potential's depth.
  const double stored = contact.touching
                            ? 0.5 * contact.stiffness * (contact.vcp - contact.tip).squaredNorm() /
                                  (1 + contact.slope.squaredNorm())
                            : 0.0;
  const double most = stored + spec_.allowed_energy;
  if (!last_tip) memory.energy = most;

  const auto size = static_cast<int>(memory.in_flight.cols());
  memory.newest = (memory.newest + 1) % size;
  memory.in_flight.col(memory.newest) = all.tip.applied;
  if (last_tip) {
    const int held = (memory.newest + size - spec_.delay) % size;
    memory.energy -= memory.in_flight.col(held).dot(contact.tip - *last_tip);
  }
  memory.energy = std::min(memory.energy, most);

  // The controller's force may switch on and off without a jump fault.
  contact.expected_force_jump += std::exchange(memory.controller_force, 0);
  if (memory.energy > -kRounding || !(contact.dt > 0)) return;
  const Vec3 velocity =
      (contact.tip - *last_tip) / contact.dt; // independent of the velocity filter
  const double square = velocity.squaredNorm();
  if (!(square > 0)) return;
  const double alpha = std::min(-memory.energy / (contact.dt * square), spec_.max_damping);
  contact.force -= alpha * velocity;
  memory.controller_force = alpha * std::sqrt(square);
  contact.expected_force_jump += memory.controller_force;
}

} // namespace patina
