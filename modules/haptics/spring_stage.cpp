#include "haptics/spring_stage.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "haptics/half_spaces.h"

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

namespace {

// Of walls that differ by less than this (about 12 degrees) only the one that bears most counts.
constexpr double kApart = 0.2;

} // namespace

Vec3 acrossWalls(const Contact& contact, const Vec3& v) noexcept {
  if (contact.walls == 1) return v.dot(contact.wall[0].normal) * contact.wall[0].normal;
  std::array<Vec3, 3> axis;
  std::size_t axes = 0;
  Vec3 across = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(contact.walls); ++i) {
    Vec3 own = contact.wall[i].normal;
    for (std::size_t j = 0; j < axes; ++j) own -= own.dot(axis[j]) * axis[j];
    const double length = own.norm();
    if (i > 0 && length < kApart) continue;
    axis[axes] = own / length;
    across += v.dot(axis[axes]) * axis[axes];
    ++axes;
  }
  return across;
}

namespace {

// What of a damper's force is left where the walls that hold the tip only push: the nearest to the
// sum with the spring's that they can bear, less the spring's.
Vec3 besideSpring(const Contact& contact, const Vec3& damper) noexcept {
  if (contact.walls == 1) {
    const auto& [normal, load] = contact.wall[0];
    return std::max(damper.dot(normal), -contact.stiffness * load) * normal;
  }
  Walls walls;
  Vec3 spring = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(contact.walls); ++i) {
    const auto& [normal, load] = contact.wall[i];
    walls.add({normal, 0, Vec3::Zero()});
    spring += contact.stiffness * load * normal;
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
  const Vec3 across = acrossWalls(contact, damper);
  contact.force += magnetic ? across : besideSpring(contact, damper);
  dampSticking(contact, damper - across);
}

void DampingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  dampWalls(contact, contact.material.damping, magnetic_);
}

} // namespace patina
