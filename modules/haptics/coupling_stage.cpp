#include "haptics/coupling_stage.h"

namespace patina {

double inSeries(double stiffness, double coupling) noexcept {
  if (!(stiffness > 0 && coupling > 0)) return 0;
  return 1 / (1 / stiffness + 1 / coupling);
}

void CouplingStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const Vec3& n = contact.normal;
  if (contact.attracted)
    contact.force -= contact.attraction * damping_ * contact.velocity.dot(n) * n;
  if (!contact.touching) return;
  const Vec3 stretch = contact.vcp - contact.tip;
  Vec3 rate = Vec3::Zero();
  if (memory.has_stretch && contact.dt > 0) rate = (stretch - memory.last_stretch) / contact.dt;
  memory.last_stretch = stretch;
  memory.has_stretch = true;

  contact.stiffness = stiffness_;
  const double rate_n = rate.dot(n);
  contact.force = stiffness_ * stretch + damping_ * rate_n * n;
  const double f_n = contact.force.dot(n);
  if (f_n < 0 && !magnetic_) contact.force -= f_n * n;

  if (!(contact.stick_radius > 0)) return;
  contact.force += damping_ * (rate - rate_n * n);
  const Vec3 drag = contact.force - stiffness_ * (contact.candidate - contact.tip);
  const Vec3 tangential = drag - drag.dot(n) * n;
  // The margin keeps rounding from touching a force that was within the bound undamped.
  const double bearable = stiffness_ * contact.stick_radius * (1 + 1e-9);
  const double magnitude = tangential.norm();
  if (magnitude > bearable) contact.force -= (1 - bearable / magnitude) * tangential;
}

} // namespace patina
