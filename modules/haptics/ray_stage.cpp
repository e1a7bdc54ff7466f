#include "haptics/ray_stage.h"

#include <cmath>

#include "haptics/ray_search.h"

namespace patina {
namespace {

constexpr double kMinGradient = 0.1; // K05

Vec3 directionAt(const GridSample& sample, const ContactMemory& memory) noexcept {
  const double squared = sample.gradient.squaredNorm();
  if (squared >= kMinGradient * kMinGradient) return sample.gradient / std::sqrt(squared);
  return memory.in_contact ? memory.last_normal : Vec3::Zero();
}

} // namespace

RayStage::RayStage(std::shared_ptr<const SurfaceField> field, Sampler sampler, double iso)
    : field_(std::move(field)), sampler_(*field_, sampler), voxel_(field_->grid.voxel),
      per_voxel_(1 / voxel_), iso_(iso * per_voxel_) {}

void RayStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const Vec3 q = per_voxel_ * (contact.tip - sampler_.grid().origin);
  const GridSample sample = sampler_.atGrid(q);
  contact.samples = 1;
  memory.clearance = sample.phi - iso_;
  if (!(memory.clearance < 0)) {
    memory.leaveContact();
    return;
  }
  contact.touching = true;
  contact.deep = sample.region == FieldRegion::deep;
  contact.normal = directionAt(sample, memory);
  double depth = -memory.clearance;
  if (!contact.normal.isZero()) {
    const RayRoot root = rayRoot(sampler_, q, contact.normal, depth, iso_);
    contact.samples += root.samples;
    // A distance's own slope is 1; where the blended gradient is shorter, at a crease, dividing by
    // it would throw the VCP far beyond the part.
    if (root.found) depth = root.s;
  }
  contact.depth = depth * voxel_;
  contact.candidate = contact.tip + contact.depth * contact.normal;
  contact.vcp = contact.candidate;
  contact.surface = contact.candidate - iso_ * voxel_ * contact.normal;
  contact.wall[0] = {contact.normal, contact.depth};
  contact.walls = 1;
  contact.snap = memory.in_contact && contact.normal.dot(memory.last_normal) < 0;
  if (contact.snap) contact.slip_step = (contact.candidate - memory.last_candidate).norm();
  memory.in_contact = true;
  memory.last_candidate = contact.candidate;
  memory.last_normal = contact.normal;
}

} // namespace patina
