// The spring between tip and virtual contact point, and its damper (K07, K08).
#pragma once

#include "haptics/stages/stage.h"

namespace patina {

// F = K (p - x), K of the contact's material.
class SpringStage final : public ForceStage {
 public:
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
};

struct VelocityFilterMemory {
  Vec3 velocity = Vec3::Zero(); // [m/s]
};

// contact.velocity through a first-order low-pass: less noise of a coarse encoder for a delay that
// lowers the stability limit of the damping behind it (MATH 2.1.4).
class VelocityFilterStage final : public ForceStage {
 public:
  explicit VelocityFilterStage(double cutoff_hz);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  double time_; // [s]
};

// Damps the tip's motion across the walls that hold its contact point: F -= B v as far as these can
// bear the whole of it, so that none pulls (K08) and the damper's part is at most B |v|, however
// nearly two walls are one. A magnetic surface bears pulls too; then that of a magnet is damped as
// well. It is the tip that is damped, not the way to the contact point: a point that turns round a
// crease must not become a push. While the VCP sticks, the tip's motion along the walls is damped
// as well (MATH 2.6), within what sticking can bear.
void dampWalls(Contact& contact, double damping, bool magnetic) noexcept;

// dampWalls() with B of the contact's material, of the scene where a magnet pulls.
class DampingStage final : public ForceStage {
 public:
  explicit DampingStage(bool magnetic = false) : magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool magnetic_;
};

} // namespace patina
