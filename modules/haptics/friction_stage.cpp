#include "haptics/friction_stage.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kTrailVoxels = 0.05;
constexpr double kMinGradient = 0.1;

} // namespace

FrictionStage::FrictionStage(std::shared_ptr<const SurfaceField> field, Sampler sampler,
                             double tip_radius, const Friction& friction)
    : field_(std::move(field)), sampler_(*field_, sampler), friction_(friction),
      iso_(tip_radius / field_->grid.voxel), trail_(kTrailVoxels * field_->grid.voxel) {}

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
  const Vec3 behind = memory.trail - c;
  const double lag = behind.norm();
  if (lag > trail_) memory.trail = c + trail_ / lag * behind;

  if ((memory.stuck - c).norm() <= (memory.slipping ? slip : stick)) {
    memory.slipping = false;
    contact.stick_radius = stick;
    contact.vcp = memory.stuck;
    return;
  }
  Vec3 p = c;
  if (slip > 0) {
    p = c + slip * slipDirection(c, memory);
    const bool on_surface = !contact.held && !contact.approximate && !memory.has_handover;
    if (on_surface) {
      // Projected, then back to the same distance: what the projection takes from it must not look
      // like a return to sticking.
      const Vec3 offset = ontoSurface(p, slip) - c;
      p = c + slip / std::max(offset.norm(), 0.5 * slip) * offset;
    }
  }
  if (!memory.slipping) contact.slip_step = (p - memory.stuck).norm();
  memory.slipping = true;
  memory.stuck = p;
  contact.vcp = p;
}

Vec3 FrictionStage::slipDirection(const Vec3& candidate,
                                  const ContactMemory& memory) const noexcept {
  if (friction_.slip == Friction::SlipDirection::displacement) {
    const Vec3 behind = memory.trail - candidate;
    const double lag = behind.norm();
    if (lag > 0.5 * trail_) return behind / lag;
  }
  return (memory.stuck - candidate).normalized();
}

// One Newton step; p itself where the field does not say or the step is longer than `bound`.
Vec3 FrictionStage::ontoSurface(const Vec3& p, double bound) const noexcept {
  const GridSample sample = sampler_.at(p);
  const double squared = sample.gradient.squaredNorm();
  if (sample.region != FieldRegion::band || !(squared > kMinGradient * kMinGradient)) return p;
  const double voxel = sampler_.grid().voxel;
  const Vec3 step = (sample.phi - iso_ * voxel) / squared * sample.gradient;
  return step.squaredNorm() <= bound * bound ? Vec3(p - step) : p;
}

} // namespace patina
