#include "haptics/law/spring_stage.h"

#include <algorithm>
#include <numbers>

#include "haptics/contact/active_constraints.h"
#include "haptics/contact/half_spaces.h"
#include "haptics/law/contact_memory.h"

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
  Vec3& filtered = memory.filter.velocity;
  filtered += share * (contact.velocity - filtered);
  contact.velocity = filtered;
}

namespace {

// Adds tangential damping while the contact point sticks, within the limit of stiction.
void dampSticking(Contact& contact, const Vec3& damper) noexcept {
  if (!(contact.stick_radius > 0)) return;
  const Vec3& n = contact.normal;
  contact.force += damper;
  const Vec3 drag = contact.force - contact.stiffness * (contact.frictionless_point - contact.tip);
  const Vec3 tangential = drag - drag.dot(n) * n;
  // The margin keeps rounding from changing a force within the limit.
  const double bearable = contact.stiffness * contact.stick_radius * (1 + 1e-9);
  const double magnitude = tangential.norm();
  if (magnitude > bearable) contact.force -= (1 - bearable / magnitude) * tangential;
}

// Returns the share of the damper's force that pushing walls can bear: projects its sum with the
// spring's force onto their cone and subtracts the spring's.
Vec3 besideSpring(const Contact& contact, const ActiveConstraints& constraints,
                  const Vec3& damper) noexcept {
  if (constraints.count() == 1) {
    const auto& [normal, load] = constraints[0];
    return std::max(damper.dot(normal), -contact.stiffness * load) * normal;
  }
  Walls walls;
  Vec3 spring = Vec3::Zero();
  for (int i = 0; i < constraints.count(); ++i) {
    walls.add({constraints[i].normal, 0, Vec3::Zero()});
    spring += contact.stiffness * constraints[i].multiplier * constraints[i].normal;
  }
  // Moreau's decomposition: the projection onto the free space is the remainder.
  return projectOntoWalls(walls, -(spring + damper)).z + damper;
}

} // namespace

void dampConstrainedMotion(Contact& contact, double damping, bool magnetic) noexcept {
  const Vec3 damper = -damping * contact.velocity;
  if (contact.attracted)
    contact.force += contact.attraction * damper.dot(contact.normal) * contact.normal;
  if (!contact.touching || damper.isZero(0)) return;
  const ActiveConstraints constraints(contact);
  const Vec3 across = constraints.constrainedPart(damper);
  contact.force += magnetic ? across : besideSpring(contact, constraints, across);
  dampSticking(contact, damper - across);
}

void DampingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  dampConstrainedMotion(contact, contact.material.damping, magnetic_);
}

} // namespace patina
