#include "haptics/stages/friction_stage.h"

#include <algorithm>
#include <cmath>

#include "haptics/contact/contact_memory.h"

namespace patina {
namespace {

constexpr double kTrailVoxels = 0.05;
constexpr double kMaxTurn = 0.1; // [rad] a tick

} // namespace

FrictionStage::FrictionStage(const FieldSampler& sampler, double tip_radius,
                             const Friction& friction, bool raised)
    : sampler_(sampler), depth_gain_(friction.depth_gain), slip_(friction.slip), raised_(raised),
      iso_(tip_radius / sampler.grid().voxel), trail_(kTrailVoxels * sampler.grid().voxel) {}

void FrictionStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double gain = 1 + depth_gain_ * contact.depth / kFrictionDepthReference;
  // Friction follows what the walls bear, which in a groove is more than what they bear together.
  double borne = 0;
  for (int i = 0; i < contact.walls; ++i) borne += contact.wall[static_cast<std::size_t>(i)].load;
  const double slip = contact.material.dynamic_friction * gain * borne;
  const double stick = std::max(contact.material.static_friction * gain * borne, slip);
  if (!contact.touching || !(stick > 0)) {
    memory.friction.grip.reset();
    return;
  }
  const Vec3& c = contact.candidate;
  if (!memory.friction.grip || contact.lets_go)
    memory.friction.grip = FrictionMemory::Grip{c, c, contact.tip};
  FrictionMemory::Grip& grip = *memory.friction.grip;
  // What runs by itself does not slip: the stuck point goes with it.
  if (contact.snap) grip.stuck += c - grip.candidate;
  grip.candidate = c;
  const Vec3 against =
      slip_ == Friction::SlipDirection::displacement ? againstMotion(contact, grip) : Vec3::Zero();

  const double radius = grip.slipping ? slip : stick;
  const Vec3 dragged = grip.stuck - c;
  const double dragged_squared = dragged.squaredNorm();
  if (dragged_squared <= radius * radius) {
    grip.slipping = false;
    contact.stick_radius = stick;
    contact.vcp = grip.stuck;
    return;
  }
  Vec3 p = c;
  if (slip > 0) {
    const Vec3 offset =
        slip * (against.isZero(0) ? Vec3(dragged / std::sqrt(dragged_squared)) : against);
    p = c + (raised_ ? offset : ontoSurface(contact, offset, slip));
  }
  if (!grip.slipping) contact.slip_step += (p - grip.stuck).norm();
  grip.slipping = true;
  grip.stuck = p;
  contact.vcp = p;
}

// Draws the trail behind the tip over the tangent plane at the candidate. A chord is the direction
// half its length ago; it is turned on as much as the path turned since the chord before. Zero
// while the trail is too short to say.
Vec3 FrictionStage::againstMotion(const Contact& contact,
                                  FrictionMemory::Grip& grip) const noexcept {
  const auto tangential = [&n = contact.normal](const Vec3& v) { return Vec3(v - v.dot(n) * n); };
  const Vec3 behind = tangential(grip.trail - contact.tip);
  const double length = behind.norm();
  grip.trail = contact.tip + behind;
  if (!(length > 0.5 * trail_)) return Vec3::Zero();
  const Vec3 direction = 1 / length * behind;
  if (length > trail_) grip.trail = contact.tip + trail_ * direction;

  const Vec3 before = tangential(grip.slide);
  grip.slide = behind;
  const double length_before = before.norm();
  const double between = 0.5 * (length + length_before) - trail_;
  // At less than a trail's length a tick the noise of the tip would be turned on with it.
  if (!(length > 2 * trail_ && length_before > 2 * trail_)) return direction;
  const Vec3 turn = direction - 1 / length_before * before;
  if (turn.squaredNorm() > kMaxTurn * kMaxTurn) return direction; // a corner, not a curve
  return (direction + 0.5 * length / between * turn).normalized();
}

// The offset from c moved by one Newton step along the contact's normal, then brought back to its
// length: what the projection takes from it must not look like a return to sticking. A step longer
// than the offset belongs to another sheet and is not taken.
Vec3 FrictionStage::ontoSurface(const Contact& contact, const Vec3& offset,
                                double length) const noexcept {
  const Vec3 p = contact.candidate + offset;
  const double f = (sampler_.phiAtGrid(sampler_.toGrid(p)) - iso_) * sampler_.grid().voxel;
  if (!(std::abs(f) < length)) return offset;
  const Vec3 projected = offset - f * contact.normal;
  const double squared = projected.squaredNorm() / (length * length);
  // One step of the inverse square root where it is exact to 1e-6, which is nearly always.
  const double scale = std::abs(squared - 1) < 1e-3 ? 1.5 - 0.5 * squared : 1 / std::sqrt(squared);
  return squared > 0.25 ? Vec3(scale * projected) : offset;
}

} // namespace patina
