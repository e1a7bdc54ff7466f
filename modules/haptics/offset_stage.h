// The offset surface: felt at a distance from the model, directed by the model itself (K12).
#pragma once

#include <memory>

#include "field/field_sampler.h"
#include "haptics/stage.h"

namespace patina {

// Follows a ContactStage whose iso-value is tip radius + offset. The magnitude stays that of the
// VCP on the offset surface; direction and properties become those of the closest point on the
// original surface (Contact::surface, brought onto phi = 0 by one Newton step: it lies
// there within O(h^2)). The offset of an edge or of a thin part is round and thick, but its
// direction is the model's. Where the original has no direction (a medial axis), the contact's
// stays.
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
