#include "haptics/magnet_stage.h"

#include <algorithm>

namespace patina {
namespace {

constexpr double kFadesFrom = 0.75; // of the range
constexpr double kWholeGradient = 0.5;

} // namespace

MagnetStage::MagnetStage(std::shared_ptr<const SurfaceField> field, Sampler sampler,
                         double tip_radius, const Magnet& magnet)
    : field_(std::move(field)), sampler_(*field_, sampler), magnet_(magnet),
      per_voxel_(1 / field_->grid.voxel), iso_(tip_radius * per_voxel_),
      range_(magnet.range * per_voxel_) {}

void MagnetStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const bool was = memory.attracted;
  memory.attracted = false;
  // memory.clearance is this tick's: the contact stage has looked.
  if (!contact.touching && memory.clearance < range_) {
    const FieldGrid& grid = sampler_.grid();
    const GridSample at = sampler_.atGrid(per_voxel_ * (contact.tip - grid.origin));
    const double above = at.phi - iso_;
    const double slope = at.gradient.norm();
    if (at.region == FieldRegion::band && slope > 0) {
      double pull = above;
      contact.attraction = 1;
      if (magnet_.fades && above > kFadesFrom * range_) {
        contact.attraction = (range_ - above) / ((1 - kFadesFrom) * range_);
        pull = kFadesFrom * range_ * contact.attraction;
      }
      const Vec3 toward = at.gradient / -std::max(slope, kWholeGradient);
      contact.force += magnet_.strength * pull * grid.voxel * toward;
      contact.normal = at.gradient / slope;
      contact.surface = contact.tip - grid.voxel * at.phi * contact.normal;
      contact.vcp = contact.surface + iso_ * grid.voxel * contact.normal;
      contact.attracted = true;
      memory.attracted = true;
    }
  }
  const bool stepped = memory.attracted != was && !magnet_.fades;
  if (stepped) contact.known_step += magnet_.strength * magnet_.range;
}

} // namespace patina
