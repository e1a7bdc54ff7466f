// Spring and damper between tip and virtual contact point (K07, K08).
#pragma once

#include "haptics/law/stage.h"

namespace patina {

// F = K (p - x) with K of the contact's material.
class SpringStage final : public ForceStage {
 public:
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
};

struct VelocityFilterMemory {
  Vec3 velocity = Vec3::Zero(); // [m/s]
};

// First-order low-pass of contact.velocity: reduces the noise of a coarse encoder, but its delay
// lowers the stability limit of the damping (MATH 2.1.4).
class VelocityFilterStage final : public ForceStage {
 public:
  explicit VelocityFilterStage(double cutoff_hz);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  double time_; // [s]
};

// Damps the tip's motion across the active walls: F -= B v as far as the walls can bear the total,
// so that none pulls (K08) and the damping force is at most B |v|, even for nearly parallel walls.
// A magnetic surface may pull, and its attraction is damped too. Damping acts on the tip, not on
// its distance to the contact point, which must not push when it turns round a crease. While the
// contact point sticks, tangential motion is damped too (MATH 2.6), within the limit of stiction.
void dampConstrainedMotion(Contact& contact, double damping, bool magnetic) noexcept;

// Applies dampConstrainedMotion() with B of the material, or the scene's B for a magnet.
class DampingStage final : public ForceStage {
 public:
  explicit DampingStage(bool magnetic = false) : magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool magnetic_;
};

} // namespace patina
