// Lateral coupling: stabilises a texture that is stiffer along the surface than the loop allows
// (F7), without softening the normal spring.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "haptics/law/relief_stage.h"
#include "haptics/law/stabilisers.h"
#include "haptics/law/stage.h"

namespace patina {

struct LateralMemory {
  Vec3 lateral_offset = Vec3::Zero(); // Contact::lateral_offset in the last tick
  Vec3 surface = Vec3::Zero();        // surface point that it starts from
};

// A texture of curvature h'' under a normal force P has the tangential stiffness P h'' for any K.
// This stage evaluates relief and roughness at an offset u (Contact::lateral_offset) from the
// smooth surface point s, tied to s by a spring k_l and a damper B. With D the depth at s and h the
// height of all textures,
//   U = 1/2 k_l |u|^2 + 1/2 k (D + h(s + u))_+^2,   k = K k_c / (K + k_c),
// each tick minimises U + B |du|^2 / (2 T) from the last u and never increases it. The force of the
// relief and roughness stages at s + u, the gradient of U with respect to s at fixed u, is then B
// du/T + k_l u along the surface: its stiffness is that of P h'' and k_l in series. B dissipates
// the energy of a jump from one valley to the next. Two walls leave u their line
// (active_constraints.h), three leave zero; s stays on the line of two walls even if they are
// nearly one (pull_back.h).
//
// Runs before relief and roughness and after the material. Objects whose texture is stable by the
// plan are unchanged: u = 0, unlimited k_l.
class LateralStage final : public ForceStage {
 public:
  // reliefs: null without relief.
  LateralStage(std::shared_ptr<const Reliefs> reliefs, std::span<const HapticObject> objects,
               double envelope, const LateralPlan& plan);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  struct Height;
  Height heightAt(const Contact& contact, const Vec3& lateral_offset,
                  ReliefWalk& walk) const noexcept;

  std::shared_ptr<const Reliefs> reliefs_;
  std::span<const HapticObject> objects_;
  std::vector<bool> stiff_; // index: object
  double envelope_;         // height of the envelope of all relief [m]
  LateralPlan plan_;
};

} // namespace patina
