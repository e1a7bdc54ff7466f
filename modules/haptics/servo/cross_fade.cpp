#include "haptics/servo/cross_fade.h"

namespace patina {
namespace {

Contact lawTick(const HapticSnapshot* law, ContactMemory& memory, const Vec3& tip,
                double dt) noexcept {
  if (law) return tick(*law, memory, tip, dt);
  Contact nothing;
  nothing.tip = nothing.candidate = nothing.vcp = nothing.surface = tip;
  return nothing;
}

} // namespace

void CrossFade::turnTo(const HapticSnapshot* next) noexcept {
  if (next == felt_) return;
  next_ = next;
  fading_ = true;
  weight_ = 0;
  next_memory_ = memory_;
  if (!felt_ || !next) next_memory_.leaveContact();
  if (!felt_) next_memory_.has_last_tip = false; // nobody has followed the tip
  next_memory_.reseat = true;
  // What the old law measured is not the new one's: neither its force nor its clearance.
  next_memory_.has_last_raw = false;
  next_memory_.clearance = std::numeric_limits<double>::infinity();
  next_memory_.relief.known = next_memory_.roughness.known = false;
  // A stage that only the new law has begins afresh.
  next_memory_.aside.setZero();
  next_memory_.has_damped = false;
}

Contact CrossFade::tick(const Vec3& tip, double dt) noexcept {
  if (!fading_) return lawTick(felt_, memory_, tip, dt);
  const Vec3 old = lawTick(felt_, memory_, tip, dt).force;
  Contact contact = lawTick(next_, next_memory_, tip, dt);
  const double apart = (contact.force - old).norm();
  weight_ = apart * (1 - weight_) <= kEditStep ? 1 : weight_ + kEditStep / apart;
  contact.force = old + weight_ * (contact.force - old);
  // What the device holds, for the ledgers of both.
  memory_.applied = next_memory_.applied = contact.force;
  if (weight_ < 1) return contact;
  felt_ = next_;
  memory_ = next_memory_;
  fading_ = false;
  return contact;
}

} // namespace patina
