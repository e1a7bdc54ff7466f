// The offset surface: felt at a distance from the model, directed by the model itself (K12).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/stages/stage.h"

namespace patina {

// Follows a contact stage whose iso-value is tip radius + offset, which gives magnitude and
// direction: the contact point keeps this distance from the model, also round an edge and in a
// corner. This stage finds the closest point of the model itself, for what is seen and for
// properties: Contact::surface, brought onto phi = 0 by one Newton step, lies there within O(h^2).
class OffsetStage final : public ForceStage {
 public:
  explicit OffsetStage(const FieldSampler& sampler) : sampler_(sampler) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
};

} // namespace patina
