// Virtual coupling: what keeps a surface of any stiffness quiet (F13, MATH 2.3).
#pragma once

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
  CouplingStage(double coupling, double damping, double most_damping, bool magnetic = false)
      : coupling_(coupling), damping_(damping), most_damping_(most_damping), magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "coupling"; }

 private:
  double coupling_; // k_c [N/m]
  double damping_;  // B [N s/m]
  double most_damping_;
  bool magnetic_;
};

} // namespace patina
