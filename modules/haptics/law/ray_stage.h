// Contact point of the paper: exit of a ray along the field's gradient (K03, K05, K06).
#pragma once

#include "field/sampling/field_sampler.h"
#include "haptics/law/stage.h"

namespace patina {

struct RayMemory {
  Vec3 normal = Vec3::Zero(); // last valid direction of this contact (K05); zero: none
};

// Sets touching, normal, frictionless_point, vcp (the same), depth and surface from the tip alone.
// Past the medial axis the force reverses (T-K12b); across creases the ray may miss the surface,
// and closed paths may generate energy: ProxyStage avoids both. Without a gradient the last
// direction holds; without a crossing the distance (F9). Below the band the coarse nodes give the
// direction.
class RayStage final : public ForceStage {
 public:
  // iso [m]: tip radius plus offset (K12).
  RayStage(const FieldSampler& sampler, double iso);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  double voxel_;
  double iso_; // [voxels]
};

} // namespace patina
