// The spring between tip and virtual contact point, and its damper (K07, K08).
#pragma once

#include "haptics/stage.h"

namespace patina {

// F = K (p - x), K of the contact's material.
class SpringStage final : public ForceStage {
 public:
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "spring"; }
};

// contact.velocity through a first-order low-pass: less noise of a coarse encoder for a delay that
// lowers the stability limit of the damping behind it (2.1.4).
class VelocityFilterStage final : public ForceStage {
 public:
  explicit VelocityFilterStage(double cutoff_hz);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "velocity filter"; }

 private:
  double time_; // [s]
};

// While the VCP sticks, adds a tangential damper's force [N] as far as sticking can bear
// (section 2.6).
void dampSticking(Contact& contact, const Vec3& damper) noexcept;

// F -= B (v.n) n, B of the contact's material (of the scene, where a magnet pulls), then F.n >= 0:
// the surface never pulls, unless it is magnetic (K08); there the pull is damped as well. While the
// VCP sticks, its tangential motion is damped as well (section 2.6), within what sticking can bear.
class DampingStage final : public ForceStage {
 public:
  explicit DampingStage(bool magnetic = false) : magnetic_(magnetic) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "damping"; }

 private:
  bool magnetic_;
};

} // namespace patina
