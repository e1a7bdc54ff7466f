// Magnetic surface: attracts the tip near the model (K13).
#pragma once

#include <memory>

#include "field/sampling/field_sampler.h"
#include "haptics/law/material_stage.h"
#include "haptics/law/relief_stage.h"
#include "haptics/law/stage.h"
#include "scene/haptic_properties.h"

namespace patina {

// Relief above phi = 0, if any.
struct MagnetRelief {
  std::shared_ptr<const Reliefs> reliefs;
  std::shared_ptr<const OwnerStage> owners; // set with several objects
  bool tilt_normal = false; // tilts the pull by the relief gradient (conservative form)
};

struct MagnetMemory {
  bool attracted = false; // attracted in the last tick
};

// The tip without contact, at 0 < phi < w above the surface offset by the tip's radius, F = -k_m
// phi n; in contact the contact's stages act. With `fades` the pull decreases linearly from its
// value at 3/4 w to zero at w. Between two equally near parts (a groove) the blended gradient is
// short; below half its length the pull decreases with it, so that the force is continuous. The
// jump of the paper's form at phi = w is announced in Contact::expected_force_jump. Above relief,
// phi is replaced by the height above it, and the pull tilts as in contact. Damping is the scene's.
class MagnetStage final : public ForceStage {
 public:
  MagnetStage(const FieldSampler& sampler, double tip_radius, const Magnet& magnet,
              MagnetRelief relief, double damping);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  Magnet magnet_;
  MagnetRelief relief_;
  double iso_;     // [voxels]
  double range_;   // [voxels]
  double damping_; // [N s/m]
};

} // namespace patina
