// Virtual coupling (Adams & Hannaford 1999): stabilises surfaces of any stiffness (F13, MATH 2.3).
#pragma once

#include "haptics/law/stabilisers.h"
#include "haptics/law/stage.h"

namespace patina {

// Stiffness of two springs in series; finite if either is infinite.
double inSeries(double stiffness, double coupling) noexcept;

struct CouplingMemory {
  bool touched = false; // contact in the last tick
};

// Replaces spring, velocity filter and damping. A spring k_c in series with the surface's stiffness
// K connects the tip to the contact point, with damping B (dampConstrainedMotion) of the plan, or
// of the material if that is larger, up to max_damping:
//   F = k (p - x) - B v across the walls,  k = K k_c / (K + k_c).
// Tangential motion is damped by B s^2, with s the share that the surface's curvature keeps the
// contact point from following: s = d / (R + d) in a concavity of radius R, 0 on a plane.
class CouplingStage final : public ForceStage {
 public:
  CouplingStage(const CouplingPlan& plan, bool magnetic) : plan_(plan), magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  CouplingPlan plan_;
  bool magnetic_;
};

} // namespace patina
