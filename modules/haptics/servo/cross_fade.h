// Edits while touching: from one force law to the next without a step (MATH 2.4).
#pragma once

#include "haptics/servo/snapshot.h"

namespace patina {

// With the tip held still the force changes by no more than this a tick, whatever was edited.
inline constexpr double kEditStep = 0.04; // [N]

// Both laws see the same tip; the force passes from one to the other with a weight that grows by
// kEditStep / |F_new - F_old| a tick, at once where the two agree. One mechanism for stiffness,
// mode, offset, material, relief and objects: it is the parameters' mixture that ramps. The rate of
// the loop's own force is never limited (F13): where the tip moves, both laws answer in full. Costs
// a second tick while it lasts.
class CrossFade {
 public:
  // What is felt, or, while fading, what was. Null: nothing, no force; that, too, fades.
  const HapticSnapshot* felt() const noexcept { return felt_; }
  bool fading() const noexcept { return fading_; }
  // Not while fading. `next` and felt() must live until the fade has ended. Contact goes on from
  // where it is: the contact point stays, or is brought onto the new surface on the side where it
  // was.
  void turnTo(const HapticSnapshot* next) noexcept;
  // As tick() of snapshot.h. The record is the new law's, its force the mixture.
  Contact tick(const Vec3& tip, double dt) noexcept;
  // Nobody has followed the tip: the next tick is as the first, under whichever law.
  void lose() noexcept {
    memory_.reset();
    next_memory_.reset();
  }
  // The field that the record of the last tick speaks of; null where nothing is felt.
  const SurfaceField* field() const noexcept {
    const HapticSnapshot* law = fading_ ? next_ : felt_;
    return law ? law->field.get() : nullptr;
  }

 private:
  const HapticSnapshot* felt_ = nullptr;
  const HapticSnapshot* next_ = nullptr; // while fading
  ContactMemory memory_;
  ContactMemory next_memory_;
  double weight_ = 0; // of the new law
  bool fading_ = false;
};

} // namespace patina
