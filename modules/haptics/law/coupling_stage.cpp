#include "haptics/law/coupling_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/contact/active_constraints.h"
#include "haptics/law/contact_memory.h"

namespace patina {

double inSeries(double stiffness, double coupling) noexcept {
  if (!(stiffness > 0 && coupling > 0)) return 0;
  if (std::isinf(coupling)) return stiffness;
  return 1 / (1 / stiffness + 1 / coupling);
}

namespace {

// Tangential velocity of the tip that the contact point does not follow, times its share: the
// surface's curvature constrains it (K d / (R + d) in a concavity), with the same stiffness.
Vec3 constrainedMotion(const Contact& contact) noexcept {
  const Vec3 along = contact.dt * (contact.velocity -
                                   ActiveConstraints(contact).constrainedPart(contact.velocity));
  const double squared = along.squaredNorm();
  if (!(squared > 0)) return Vec3::Zero();
  const double share = std::clamp(1 - contact.displacement.dot(along) / squared, 0.0, 1.0);
  return share * share / contact.dt * along;
}

} // namespace

void CouplingStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (contact.touching) {
    contact.stiffness = inSeries(contact.material.stiffness, plan_.stiffness);
    contact.force = contact.stiffness * (contact.vcp - contact.tip);
  }
  const double damping =
      std::max(plan_.damping, std::min(contact.material.damping, plan_.max_damping));
  dampConstrainedMotion(contact, damping, magnetic_);
  if (contact.touching && memory.coupling.touched && !(contact.stick_radius > 0))
    contact.force -= damping * constrainedMotion(contact);
  memory.coupling.touched = contact.touching;
}

} // namespace patina
