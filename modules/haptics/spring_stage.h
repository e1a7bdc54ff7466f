// The spring between tip and virtual contact point, and its damper (K07, K08).
#pragma once

#include "haptics/stage.h"

namespace patina {

// F = K (p - x).
class SpringStage final : public ForceStage {
 public:
  explicit SpringStage(double stiffness) : stiffness_(stiffness) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "spring"; }

 private:
  double stiffness_; // [N/m]
};

// F -= B (v.n) n, then F.n >= 0: the surface never pulls. While the VCP sticks, its tangential
// motion is damped as well (section 2.6), within what sticking can bear.
class DampingStage final : public ForceStage {
 public:
  explicit DampingStage(double damping) : damping_(damping) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "damping"; }

 private:
  double damping_; // [N s/m]
};

} // namespace patina
