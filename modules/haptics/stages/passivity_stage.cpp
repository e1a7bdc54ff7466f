#include "haptics/stages/passivity_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/contact/contact_memory.h"

namespace patina {

void PassivityStage::apply(Contact& contact, ContactMemory& all) const noexcept {
  PassivityMemory& memory = all.passivity;
  const std::optional<Vec3>& last_tip = all.tip.last;
  // On a slope of relief the VCP lies farther than the potential's depth.
  const double stored = contact.touching
                            ? 0.5 * contact.stiffness * (contact.vcp - contact.tip).squaredNorm() /
                                  (1 + contact.slope.squaredNorm())
                            : 0.0;
  const double most = stored + spec_.reserve;
  if (!last_tip) memory.energy = most;

  const auto size = static_cast<int>(memory.in_flight.cols());
  memory.newest = (memory.newest + 1) % size;
  memory.in_flight.col(memory.newest) = all.tip.applied;
  if (last_tip) {
    const int held = (memory.newest + size - spec_.delay) % size;
    memory.energy -= memory.in_flight.col(held).dot(contact.tip - *last_tip);
  }
  memory.energy = std::min(memory.energy, most);

  // Both the brake's coming and its going are steps of its own, and no jump.
  contact.known_step += std::exchange(memory.brake, 0);
  if (memory.energy > -kRounding || !(contact.dt > 0)) return;
  const Vec3 velocity = (contact.tip - *last_tip) / contact.dt; // also behind a filter
  const double square = velocity.squaredNorm();
  if (!(square > 0)) return;
  const double alpha = std::min(-memory.energy / (contact.dt * square), spec_.most);
  contact.force -= alpha * velocity;
  memory.brake = alpha * std::sqrt(square);
  contact.known_step += memory.brake;
}

} // namespace patina
