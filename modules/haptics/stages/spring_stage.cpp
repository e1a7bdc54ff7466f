#include "haptics/stages/spring_stage.h"

#include <algorithm>
#include <numbers>

#include "haptics/contact/contact_memory.h"
#include "haptics/contact/half_spaces.h"
#include "haptics/contact/hold.h"

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

// While the VCP sticks, adds a tangential damper's force as far as sticking can bear.
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

// What of a damper's force is left where the walls that hold the tip only push: the nearest to the
// sum with the spring's that they can bear, less the spring's.
Vec3 besideSpring(const Contact& contact, const WallHold& hold, const Vec3& damper) noexcept {
  if (hold.count() == 1) {
    const auto& [normal, load] = hold[0];
    return std::max(damper.dot(normal), -contact.stiffness * load) * normal;
  }
  Walls walls;
  Vec3 spring = Vec3::Zero();
  for (int i = 0; i < hold.count(); ++i) {
    walls.add({hold[i].normal, 0, Vec3::Zero()});
    spring += contact.stiffness * hold[i].load * hold[i].normal;
  }
  // What holds a point in front of the walls into which the sum pushes (Moreau).
  return projectOntoWalls(walls, -(spring + damper)).z + damper;
}

} // namespace

void dampWalls(Contact& contact, double damping, bool magnetic) noexcept {
  const Vec3 damper = -damping * contact.velocity;
  if (contact.attracted)
    contact.force += contact.attraction * damper.dot(contact.normal) * contact.normal;
  if (!contact.touching || damper.isZero(0)) return;
  const WallHold hold(contact);
  const Vec3 across = hold.across(damper);
  contact.force += magnetic ? across : besideSpring(contact, hold, across);
  dampSticking(contact, damper - across);
}

void DampingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  dampWalls(contact, contact.material.damping, magnetic_);
}

} // namespace patina
