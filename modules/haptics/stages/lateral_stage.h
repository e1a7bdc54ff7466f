// Lateral coupling: what keeps a texture quiet that is stiffer along the surface than the loop can
// bear (F7), while the normal spring stays as it is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "haptics/stability/stabilisers.h"
#include "haptics/stages/relief_stage.h"
#include "haptics/stages/stage.h"

namespace patina {

struct LateralMemory {
  Vec3 aside = Vec3::Zero();   // Contact::aside, a tick ago
  Vec3 surface = Vec3::Zero(); // the surface's point that it is from
};

// Texture of slope h' and second derivative h'' under a normal force P makes P h'' of stiffness
// along the surface, whatever K is. Here the point at which relief and roughness are read is not
// held beneath the tip, but tied to it by a spring k_l and a damper B along the surface. With s the
// contact's point of the smooth surface, D the depth there and h the height of all texture,
//   U = 1/2 k_l |u|^2 + 1/2 k (D + h(s + u))_+^2,   k = K k_c / (K + k_c),
// and each tick moves u (Contact::aside) to where U + B |du|^2 / (2 T) is least, from its last
// place, never uphill. Relief and roughness stages read at s + u; their force, by the gradient of U
// along s with u held, is then B du/T + k_l u along the surface: stiffness no more than k_l, that
// of P h'' and k_l in series, and damped as far as it is stiff. What a hop from one valley to the
// next frees goes into B. Along two walls (hold.h) u has their line, on three it is zero. s itself
// stays on the line of two walls however nearly they are one (pull_back.h).
//
// Ahead of relief and roughness, behind what knows the material. Objects of a texture that is
// steady by the plan are felt as without it: u = 0, k_l without bound.
class LateralStage final : public ForceStage {
 public:
  // reliefs: null where there are none.
  LateralStage(std::shared_ptr<const Reliefs> reliefs, std::span<const FeltObject> objects,
               double shell, const LateralPlan& plan);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  struct Height;
  Height heightAt(const Contact& contact, const Vec3& aside, ReliefWalk& walk) const noexcept;

  std::shared_ptr<const Reliefs> reliefs_;
  std::span<const FeltObject> objects_;
  std::vector<bool> stiff_; // by object
  double shell_;            // [m], over everything that is pulled
  LateralPlan plan_;
};

} // namespace patina
