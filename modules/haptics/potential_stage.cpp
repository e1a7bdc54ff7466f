#include "haptics/potential_stage.h"

namespace patina {

PotentialStage::PotentialStage(std::shared_ptr<const SurfaceField> field, Sampler sampler,
                               double iso)
    : field_(std::move(field)), sampler_(*field_, sampler), per_voxel_(1 / field_->grid.voxel),
      iso_(iso * per_voxel_) {}

void PotentialStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (!contact.touching || contact.held || contact.deep || memory.has_handover) return;
  const FieldGrid& grid = sampler_.grid();
  const GridSample at = sampler_.potentialAtGrid(per_voxel_ * (contact.tip - grid.origin));
  ++contact.samples;
  const double slope = at.gradient.norm();
  if (at.region != FieldRegion::band || !(slope > 0) || !(at.phi < iso_)) return;
  contact.normal = at.gradient / slope;
  contact.depth = (iso_ - at.phi) * slope * grid.voxel;
  contact.candidate = contact.tip + contact.depth * contact.normal;
  contact.vcp = contact.candidate;
  contact.surface = contact.candidate - iso_ * grid.voxel * contact.normal;
}

} // namespace patina
