// Virtual coupling: what keeps a surface of any stiffness quiet (F13, MATH 2.3).
#pragma once

#include "haptics/stage.h"

namespace patina {

// Two springs in a row; finite where either is infinite.
double inSeries(double stiffness, double coupling) noexcept;

// Takes the place of spring, velocity filter and damping. The tip is tied to the virtual contact
// point by a spring k_c in series with the surface's own and by a damper on the vector s = p - x
// between them:
//   F = k s + B ds/dt,  k = K k_c / (K + k_c),  then F.n >= 0 unless the surface is magnetic.
// ds/dt is the backward difference while contact lasts; the first tick of a contact has none. Along
// the surface the damper acts only while the VCP sticks (the tip slides freely otherwise), and with
// the spring it pulls no harder than sticking can bear. Behind a magnet stage its pull is damped.
class CouplingStage final : public ForceStage {
 public:
  CouplingStage(double stiffness, double coupling, double damping, bool magnetic = false)
      : stiffness_(inSeries(stiffness, coupling)), damping_(damping), magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "coupling"; }

 private:
  double stiffness_; // k [N/m]
  double damping_;   // B [N s/m]
  bool magnetic_;
};

} // namespace patina
