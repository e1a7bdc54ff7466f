// Contact as the gradient of a potential: no loop does work (T-ENER).
#pragma once

#include <memory>

#include "field/field_sampler.h"
#include "haptics/stage.h"

namespace patina {

// Follows a ContactStage. The spring's force becomes -grad of K phi*^2 / 2 with the sampler's own
// phi*: the VCP is x - phi* grad phi*. Conservative by construction, also across creases, where the
// ray of the paper is not; in exchange the force is continuous only as far as grad phi* is: on
// smooth parts it steps by O(h^2) from cell to cell, beside a crease by up to half of itself. Held
// contact and contact deeper than the band stay as they were found.
class PotentialStage final : public ForceStage {
 public:
  // iso [m]: the tip's radius plus the offset.
  PotentialStage(std::shared_ptr<const SurfaceField> field, Sampler sampler, double iso);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "potential"; }

 private:
  std::shared_ptr<const SurfaceField> field_;
  FieldSampler sampler_;
  double per_voxel_; // [1/m]
  double iso_;       // voxels
};

} // namespace patina
