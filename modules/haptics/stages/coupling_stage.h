// Virtual coupling: what keeps a surface of any stiffness quiet (F13, MATH 2.3).
#pragma once

#include "haptics/stability/stabilisers.h"
#include "haptics/stages/stage.h"

namespace patina {

// Two springs in a row; finite where either is infinite.
double inSeries(double stiffness, double coupling) noexcept;

struct CouplingMemory {
  bool touched = false; // a tick ago
};

// Takes the place of spring, velocity filter and damping. The tip is tied to the virtual contact
// point by a spring k_c in series with the surface's own, and damped (dampWalls; B is the plan's,
// or the material's where that damps more, up to most_damping):
//   F = k (p - x) - B v across the walls,  k = K k_c / (K + k_c).
// Along them it damps what the surface's curvature holds, that is by B s^2 where the contact point
// keeps back a share s of the tip's motion; s = d / (R + d) in a bowl, 0 on a plane.
class CouplingStage final : public ForceStage {
 public:
  CouplingStage(const CouplingPlan& plan, bool magnetic) : plan_(plan), magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  CouplingPlan plan_;
  bool magnetic_;
};

} // namespace patina
