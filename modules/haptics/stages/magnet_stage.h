// The magnetic surface: near the model the tip is pulled onto it (K13).
#pragma once

#include <memory>

#include "field/sampling/field_sampler.h"
#include "haptics/stages/material_stage.h"
#include "haptics/stages/relief_stage.h"
#include "haptics/stages/stage.h"
#include "scene/haptic_properties.h"

namespace patina {

// What is above phi = 0, where anything is.
struct MagnetRelief {
  std::shared_ptr<const Reliefs> reliefs;
  std::shared_ptr<const OwnerStage> owners; // where there are several objects
  bool leans = false;                       // conservative
};

struct MagnetMemory {
  bool attracted = false; // a tick ago
};

// Out of contact, in the band 0 < phi < w above the surface that the tip's radius makes:
// F = -k_m phi n. Inside, contact's own stages act. With `fades` the pull falls linearly from its
// value at 3/4 w to zero at w. Where two parts are equally near (a groove) the blended gradient is
// short; below half its length the pull falls with it, so that the force has no jump there. The
// step that the paper's form makes at phi = w is announced as Contact::known_step. Over relief the
// height above it takes phi's place, and the pull leans as contact does. Damping is the scene's.
class MagnetStage final : public ForceStage {
 public:
  MagnetStage(const FieldSampler& sampler, double tip_radius, const Magnet& magnet,
              MagnetRelief relief, double damping);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  Magnet magnet_;
  MagnetRelief relief_;
  double iso_;     // voxels
  double range_;   // voxels
  double damping_; // [N s/m]
};

} // namespace patina
