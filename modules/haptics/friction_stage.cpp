#include "haptics/friction_stage.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kTrailVoxels = 0.05;

} // namespace

FrictionStage::FrictionStage(std::shared_ptr<const SurfaceField> field, Sampler sampler,
                             double tip_radius, const Friction& friction)
    : field_(std::move(field)), sampler_(*field_, sampler), friction_(friction),
      iso_(tip_radius / field_->grid.voxel), trail_(kTrailVoxels * field_->grid.voxel),
      per_voxel_(1 / field_->grid.voxel) {}

void FrictionStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double gain = 1 + friction_.depth_gain * contact.depth / kFrictionDepthReference;
  const double stick = friction_.static_coefficient * gain * contact.depth;
  const double slip = friction_.dynamic_coefficient * gain * contact.depth;
  if (!contact.touching || !(stick > 0)) {
    memory.has_stuck = false;
    memory.slipping = false;
    return;
  }
  const Vec3& c = contact.candidate;
  if (!memory.has_stuck) {
    memory.stuck = c;
    memory.trail = c;
    memory.has_stuck = true;
    memory.slipping = false;
  }
  const Vec3 against = friction_.slip == Friction::SlipDirection::displacement
                           ? againstDisplacement(memory.trail, c)
                           : Vec3::Zero();

  const double radius = memory.slipping ? slip : stick;
  const Vec3 dragged = memory.stuck - c;
  const double dragged_squared = dragged.squaredNorm();
  if (dragged_squared <= radius * radius) {
    memory.slipping = false;
    contact.stick_radius = stick;
    contact.vcp = memory.stuck;
    return;
  }
  Vec3 p = c;
  if (slip > 0) {
    const Vec3 offset =
        slip * (against.isZero(0) ? Vec3(dragged / std::sqrt(dragged_squared)) : against);
    // Where c itself is not on the surface there is nothing to project to.
    const bool on_surface = !contact.held && !contact.approximate && !memory.has_handover;
    p = c + (on_surface ? ontoSurface(contact, offset, slip) : offset);
  }
  if (!memory.slipping) contact.slip_step = (p - memory.stuck).norm();
  memory.slipping = true;
  memory.stuck = p;
  contact.vcp = p;
}

// Draws the trail behind the candidate; the unit vector towards it, or zero while it is too short
// to say.
Vec3 FrictionStage::againstDisplacement(Vec3& trail, const Vec3& candidate) const noexcept {
  const Vec3 behind = trail - candidate;
  const double squared = behind.squaredNorm();
  if (!(squared > 0.25 * trail_ * trail_)) return Vec3::Zero();
  const Vec3 direction = 1 / std::sqrt(squared) * behind;
  if (squared > trail_ * trail_) trail = candidate + trail_ * direction;
  return direction;
}

// The offset from c moved by one Newton step along the contact's normal, then brought back to its
// length: what the projection takes from it must not look like a return to sticking. A step longer
// than the offset belongs to another sheet and is not taken.
Vec3 FrictionStage::ontoSurface(const Contact& contact, const Vec3& offset,
                                double length) const noexcept {
  const FieldGrid& grid = sampler_.grid();
  const Vec3 p = contact.candidate + offset;
  const double f = (sampler_.phiAtGrid(per_voxel_ * (p - grid.origin)) - iso_) * grid.voxel;
  if (!(std::abs(f) < length)) return offset;
  const Vec3 projected = offset - f * contact.normal;
  const double squared = projected.squaredNorm() / (length * length);
  // One step of the inverse square root where it is exact to 1e-6, which is nearly always.
  const double scale = std::abs(squared - 1) < 1e-3 ? 1.5 - 0.5 * squared : 1 / std::sqrt(squared);
  return squared > 0.25 ? Vec3(scale * projected) : offset;
}

} // namespace patina
