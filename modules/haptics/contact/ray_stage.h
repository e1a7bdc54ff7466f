// The contact point as in the paper: where a ray along the field's direction leaves (K03, K05,
// K06).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/stages/stage.h"

namespace patina {

struct RayMemory {
  Vec3 normal = Vec3::Zero(); // last valid direction of this contact (K05); zero: there was none
};

// Sets touching, normal, candidate, vcp (= candidate), depth and surface from the tip alone. Past
// the middle of a part the force turns round (T-K12b); across creases the ray may miss the surface,
// and loops may do work: ProxyStage does neither. Where the direction has no length the last one
// holds; a ray that finds no surface takes the distance (F9). Deeper than the band the direction
// is that of the coarse nodes.
class RayStage final : public ForceStage {
 public:
  // iso [m]: the tip's radius plus the offset (K12).
  RayStage(const FieldSampler& sampler, double iso);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  double voxel_;
  double iso_; // voxels
};

} // namespace patina
