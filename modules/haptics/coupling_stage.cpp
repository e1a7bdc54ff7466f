#include "haptics/coupling_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/spring_stage.h"

namespace patina {

double inSeries(double stiffness, double coupling) noexcept {
  if (!(stiffness > 0 && coupling > 0)) return 0;
  if (std::isinf(coupling)) return stiffness;
  return 1 / (1 / stiffness + 1 / coupling);
}

void CouplingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (contact.touching) {
    contact.stiffness = inSeries(contact.material.stiffness, coupling_);
    contact.force = contact.stiffness * (contact.vcp - contact.tip);
  }
  dampWalls(contact, std::max(damping_, std::min(contact.material.damping, most_damping_)),
            magnetic_);
}

} // namespace patina
