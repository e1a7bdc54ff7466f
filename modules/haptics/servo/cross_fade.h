// Cross-fades from one force law to the next after an edit, without a force step (MATH 2.4).
#pragma once

#include "haptics/law/snapshot.h"

namespace patina {

// Largest force change per tick by an edit while the tip rests.
inline constexpr double kEditStep = 0.04; // [N]

// Evaluates both laws at the same tip and blends the forces; the new law's weight grows by
// kEditStep / |F_new - F_old| per tick, to 1 at once if they agree. This covers every edit
// (stiffness, mode, offset, material, relief, objects), because it blends results and not
// parameters. The force rate itself is never limited (F13): both laws respond fully to the tip's
// motion. Costs a second evaluation per tick during the fade.
class CrossFade {
 public:
  // Law in use; during a fade the old one. Null: no law and no force, which is faded as well.
  const HapticSnapshot* active() const noexcept { return active_; }
  bool fading() const noexcept { return fading_; }
  // Starts a fade; not allowed during one. `next` and the active law must live until its end. The
  // contact point stays, or is reprojected onto the new surface on its own side.
  void fadeTo(const HapticSnapshot* next) noexcept;
  // As tick() of snapshot.h. Returns the new law's record with the blended force.
  Contact tick(const Vec3& tip, double dt) noexcept;
  // Discards the contact state after unobserved motion; the next tick is a first one.
  void resetContact() noexcept {
    memory_.reset();
    next_memory_.reset();
  }

 private:
  const HapticSnapshot* active_ = nullptr;
  const HapticSnapshot* next_ = nullptr; // set during a fade
  ContactMemory memory_;
  ContactMemory next_memory_;
  double weight_ = 0; // weight of the new law
  bool fading_ = false;
};

} // namespace patina
