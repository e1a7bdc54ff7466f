#include "haptics/spring_stage.h"

#include <numbers>

namespace patina {

void SpringStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (!contact.touching) return;
  contact.stiffness = contact.material.stiffness;
  contact.force = contact.stiffness * (contact.vcp - contact.tip);
}

VelocityFilterStage::VelocityFilterStage(double cutoff_hz)
    : time_(1 / (2 * std::numbers::pi * cutoff_hz)) {}

void VelocityFilterStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double share = contact.dt > 0 ? contact.dt / (contact.dt + time_) : 0;
  memory.velocity += share * (contact.velocity - memory.velocity);
  contact.velocity = memory.velocity;
}

void dampSticking(Contact& contact, const Vec3& damper) noexcept {
  if (!(contact.stick_radius > 0)) return;
  const Vec3& n = contact.normal;
  contact.force += damper;
  const Vec3 drag = contact.force - contact.stiffness * (contact.candidate - contact.tip);
  const Vec3 tangential = drag - drag.dot(n) * n;
  // The margin keeps rounding from touching a force that was within the bound undamped.
  const double bearable = contact.stiffness * contact.stick_radius * (1 + 1e-9);
  const double magnitude = tangential.norm();
  if (magnitude > bearable) contact.force -= (1 - bearable / magnitude) * tangential;
}

void DampingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (!contact.touching && !contact.attracted) return;
  const Vec3& n = contact.normal;
  const double v_n = contact.velocity.dot(n);
  const double damping = contact.material.damping;
  const double share = contact.touching ? 1 : contact.attraction;
  contact.force -= share * damping * v_n * n;
  const double f_n = contact.force.dot(n);
  if (f_n < 0 && !magnetic_) contact.force -= f_n * n;

  dampSticking(contact, -damping * (contact.velocity - v_n * n));
}

} // namespace patina
