// The offset surface: felt at a distance from the model, directed by the model itself (K12).
#pragma once

#include <memory>

#include "field/field_sampler.h"
#include "haptics/stage.h"

namespace patina {

// Follows a ContactStage whose iso-value is tip radius + offset, which gives magnitude and
// direction: of a distance, the gradient at the tip is the direction from the closest point of the
// original to the tip, also round an edge, where the normal that the field has at that point itself
// is a blend of both faces' and would do work round a loop (T-ENER). This stage finds the closest
// point, for what is seen and for properties: Contact::surface, brought onto phi = 0 by one Newton
// step, lies there within O(h^2).
class OffsetStage final : public ForceStage {
 public:
  OffsetStage(std::shared_ptr<const SurfaceField> field, Sampler sampler);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "offset"; }

 private:
  std::shared_ptr<const SurfaceField> field_;
  FieldSampler sampler_;
  double per_voxel_; // [1/m]
};

} // namespace patina
