#include "haptics/coupling_stage.h"

#include <algorithm>

#include "haptics/spring_stage.h"

namespace patina {

double inSeries(double stiffness, double coupling) noexcept {
  if (!(stiffness > 0 && coupling > 0)) return 0;
  return 1 / (1 / stiffness + 1 / coupling);
}

void CouplingStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const Vec3& n = contact.normal;
  const double damping = std::max(damping_, std::min(contact.material.damping, most_damping_));
  if (contact.attracted)
    contact.force -= contact.attraction * damping * contact.velocity.dot(n) * n;
  if (!contact.touching) return;
  const Vec3 stretch = contact.vcp - contact.tip;
  Vec3 rate = Vec3::Zero();
  if (memory.has_stretch && contact.dt > 0) rate = (stretch - memory.last_stretch) / contact.dt;
  memory.last_stretch = stretch;
  memory.has_stretch = true;

  contact.stiffness = inSeries(contact.material.stiffness, coupling_);
  const double rate_n = rate.dot(n);
  contact.force = contact.stiffness * stretch + damping * rate_n * n;
  const double f_n = contact.force.dot(n);
  if (f_n < 0 && !magnetic_) contact.force -= f_n * n;

  dampSticking(contact, damping * (rate - rate_n * n));
}

} // namespace patina
