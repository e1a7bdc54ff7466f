#include "haptics/stages/passivity_stage.h"

#include <algorithm>
#include <cmath>

namespace patina {

void PassivityStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  // On a slope of relief the VCP lies farther than the potential's depth.
  const double stored = contact.touching
                            ? 0.5 * contact.stiffness * (contact.vcp - contact.tip).squaredNorm() /
                                  (1 + contact.slope.squaredNorm())
                            : 0.0;
  const double most = stored + spec_.reserve;
  if (!memory.has_last_tip) memory.energy = most;

  const auto size = static_cast<int>(memory.in_flight.cols());
  memory.newest_in_flight = (memory.newest_in_flight + 1) % size;
  memory.in_flight.col(memory.newest_in_flight) = memory.applied;
  if (memory.has_last_tip) {
    const int held = (memory.newest_in_flight + size - spec_.delay) % size;
    memory.energy -= memory.in_flight.col(held).dot(contact.tip - memory.last_tip);
  }
  memory.energy = std::min(memory.energy, most);

  // Both the brake's coming and its going are steps of its own, and no jump.
  contact.known_step += memory.brake;
  memory.brake = 0;
  if (memory.energy > -kRounding || !(contact.dt > 0)) return;
  const Vec3 velocity = (contact.tip - memory.last_tip) / contact.dt; // also behind a filter
  const double square = velocity.squaredNorm();
  if (!(square > 0)) return;
  const double alpha = std::min(-memory.energy / (contact.dt * square), spec_.most);
  contact.force -= alpha * velocity;
  memory.brake = alpha * std::sqrt(square);
  contact.known_step += memory.brake;
}

} // namespace patina
