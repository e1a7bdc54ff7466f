#include "haptics/law/magnet_stage.h"

#include <algorithm>

#include "haptics/contact/pull_back.h"
#include "haptics/law/contact_memory.h"

namespace patina {
namespace {

constexpr double kFadesFrom = 0.75; // fraction of the range
constexpr double kWholeGradient = 0.5;

} // namespace

MagnetStage::MagnetStage(const FieldSampler& sampler, double tip_radius, const Magnet& magnet,
                         MagnetRelief relief, double damping)
    : sampler_(sampler), magnet_(magnet), relief_(std::move(relief)),
      iso_(tip_radius * sampler_.perVoxel()), range_(magnet.range * sampler_.perVoxel()),
      damping_(damping) {}

void MagnetStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (!contact.touching && contact.clearance < range_) {
    const FieldGrid& grid = sampler_.grid();
    const GridSample at = sampler_.atGrid(sampler_.toGrid(contact.tip));
    double above = at.phi - iso_;
    const double slope = at.gradient.norm();
    Vec3 leaning = Vec3::Zero();
    if (relief_.reliefs && slope > 0) {
      const Vec3 n = at.gradient / slope, c = contact.tip - grid.voxel * at.phi * n;
      const std::int32_t object = relief_.owners ? relief_.owners->ownerAt(c) : 0;
      const ReliefAt raised = relief_.reliefs->at(object, c, memory.walk);
      above = std::max(0.0, above - sampler_.perVoxel() * raised.height);
      if (relief_.tilt_normal)
        leaning = closestPointJacobian(sampler_, sampler_.toGrid(c), n, at.phi) * raised.slope();
    }
    if (at.region == FieldRegion::band && slope > 0 && above < range_) {
      double pull = above;
      contact.attraction = 1;
      if (magnet_.fades && above > kFadesFrom * range_) {
        contact.attraction = (range_ - above) / ((1 - kFadesFrom) * range_);
        pull = kFadesFrom * range_ * contact.attraction;
      }
      const Vec3 toward = at.gradient / -std::max(slope, kWholeGradient) + leaning;
      contact.force += magnet_.strength * pull * grid.voxel * toward;
      contact.normal = at.gradient / slope;
      contact.surface = contact.tip - grid.voxel * at.phi * contact.normal;
      contact.vcp = contact.surface + iso_ * grid.voxel * contact.normal;
      contact.attracted = true;
      contact.material.damping = damping_;
    }
  }
  const bool stepped = contact.attracted != memory.magnet.attracted && !magnet_.fades;
  memory.magnet.attracted = contact.attracted;
  if (stepped) contact.expected_force_jump += magnet_.strength * magnet_.range;
}

} // namespace patina
