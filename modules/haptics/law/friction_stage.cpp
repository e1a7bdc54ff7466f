#include "haptics/law/friction_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/law/contact_memory.h"

namespace patina {
namespace {

constexpr double kLagVoxels = 0.05;
constexpr double kMaxTurn = 0.1; // per tick [rad]

} // namespace

FrictionStage::FrictionStage(const FieldSampler& sampler, double tip_radius,
                             const Friction& friction, bool raised)
    : sampler_(sampler), depth_gain_(friction.depth_gain), slip_(friction.slip), raised_(raised),
      iso_(tip_radius / sampler.grid().voxel), lag_(kLagVoxels * sampler.grid().voxel) {}

void FrictionStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double gain = 1 + depth_gain_ * contact.depth / kFrictionDepthReference;
  // Sum of all walls' normal forces; in a groove it exceeds the magnitude of their resultant.
  double borne = 0;
  for (int i = 0; i < contact.walls; ++i)
    borne += contact.wall[static_cast<std::size_t>(i)].multiplier;
  const double slip = contact.material.dynamic_friction * gain * borne;
  const double stick_radius = std::max(contact.material.static_friction * gain * borne, slip);
  if (!contact.touching || !(stick_radius > 0)) {
    memory.friction.stick.reset();
    return;
  }
  const Vec3& c = contact.frictionless_point;
  if (!memory.friction.stick || contact.release_stick)
    memory.friction.stick = FrictionMemory::StickState{c, c, contact.tip};
  FrictionMemory::StickState& stick = *memory.friction.stick;
  // Movement without the tip is no slip: the anchor moves along.
  if (contact.snap) stick.anchor += c - stick.frictionless_point;
  stick.frictionless_point = c;
  const Vec3 against =
      slip_ == Friction::SlipDirection::displacement ? againstMotion(contact, stick) : Vec3::Zero();

  const double radius = stick.slipping ? slip : stick_radius;
  const Vec3 dragged = stick.anchor - c;
  const double dragged_squared = dragged.squaredNorm();
  if (dragged_squared <= radius * radius) {
    stick.slipping = false;
    contact.stick_radius = stick_radius;
    contact.vcp = stick.anchor;
    return;
  }
  Vec3 p = c;
  if (slip > 0) {
    const Vec3 offset =
        slip * (against.isZero(0) ? Vec3(dragged / std::sqrt(dragged_squared)) : against);
    p = c + (raised_ ? offset : ontoSurface(contact, offset, slip));
  }
  if (!stick.slipping) contact.slip_jump += (p - stick.anchor).norm();
  stick.slipping = true;
  stick.anchor = p;
  contact.vcp = p;
}

// Moves the lagged tip behind the tip in the tangent plane and returns the direction against the
// motion. A chord has the direction half its length ago, so it is rotated on by the rotation since
// the last chord. Returns zero while the chord is too short.
Vec3 FrictionStage::againstMotion(const Contact& contact,
                                  FrictionMemory::StickState& stick) const noexcept {
  const auto tangential = [&n = contact.normal](const Vec3& v) { return Vec3(v - v.dot(n) * n); };
  const Vec3 behind = tangential(stick.lagged_tip - contact.tip);
  const double length = behind.norm();
  stick.lagged_tip = contact.tip + behind;
  if (!(length > 0.5 * lag_)) return Vec3::Zero();
  const Vec3 direction = 1 / length * behind;
  if (length > lag_) stick.lagged_tip = contact.tip + lag_ * direction;

  const Vec3 before = tangential(stick.last_lag);
  stick.last_lag = behind;
  const double length_before = before.norm();
  const double between = 0.5 * (length + length_before) - lag_;
  // At less than the lag's length per tick the rotation would amplify the tip's noise.
  if (!(length > 2 * lag_ && length_before > 2 * lag_)) return direction;
  const Vec3 turn = direction - 1 / length_before * before;
  if (turn.squaredNorm() > kMaxTurn * kMaxTurn) return direction; // a corner, not a curve
  return (direction + 0.5 * length / between * turn).normalized();
}

// Projects c + offset by a Newton step along the normal and restores the offset's length, so that
// the slip does not end. A step longer than the offset belongs to another sheet and is ignored.
Vec3 FrictionStage::ontoSurface(const Contact& contact, const Vec3& offset,
                                double length) const noexcept {
  const Vec3 p = contact.frictionless_point + offset;
  const double f = (sampler_.phiAtGrid(sampler_.toGrid(p)) - iso_) * sampler_.grid().voxel;
  if (!(std::abs(f) < length)) return offset;
  const Vec3 projected = offset - f * contact.normal;
  const double squared = projected.squaredNorm() / (length * length);
  // One Newton step for the inverse square root is exact to 1e-6 in nearly all cases.
  const double scale = std::abs(squared - 1) < 1e-3 ? 1.5 - 0.5 * squared : 1 / std::sqrt(squared);
  return squared > 0.25 ? Vec3(scale * projected) : offset;
}

} // namespace patina
