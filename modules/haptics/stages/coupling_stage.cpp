#include "haptics/stages/coupling_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/contact/contact_memory.h"
#include "haptics/contact/hold.h"

namespace patina {

double inSeries(double stiffness, double coupling) noexcept {
  if (!(stiffness > 0 && coupling > 0)) return 0;
  if (std::isinf(coupling)) return stiffness;
  return 1 / (1 / stiffness + 1 / coupling);
}

namespace {

// Of the tip's motion along the walls what the contact point does not take part in: it is what the
// surface's curvature holds (K d / (R + d) of a bowl), and as stiff.
Vec3 heldBack(const Contact& contact) noexcept {
  const Vec3 along = contact.dt * (contact.velocity - WallHold(contact).across(contact.velocity));
  const double squared = along.squaredNorm();
  if (!(squared > 0)) return Vec3::Zero();
  const double share = std::clamp(1 - contact.drawn.dot(along) / squared, 0.0, 1.0);
  return share * share / contact.dt * along;
}

} // namespace

void CouplingStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (contact.touching) {
    contact.stiffness = inSeries(contact.material.stiffness, plan_.stiffness);
    contact.force = contact.stiffness * (contact.vcp - contact.tip);
  }
  const double damping =
      std::max(plan_.damping, std::min(contact.material.damping, plan_.most_damping));
  dampWalls(contact, damping, magnetic_);
  if (contact.touching && memory.coupling.touched && !(contact.stick_radius > 0))
    contact.force -= damping * heldBack(contact);
  memory.coupling.touched = contact.touching;
}

} // namespace patina
