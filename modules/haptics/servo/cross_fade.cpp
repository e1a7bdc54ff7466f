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
  if (!felt_) next_memory_.tip.last.reset(); // nobody has followed the tip
  next_memory_.changeLaw();
}

Contact CrossFade::tick(const Vec3& tip, double dt) noexcept {
  if (!fading_) return lawTick(felt_, memory_, tip, dt);
  const Vec3 old = lawTick(felt_, memory_, tip, dt).force;
  Contact contact = lawTick(next_, next_memory_, tip, dt);
  const double apart = (contact.force - old).norm();
  weight_ = apart * (1 - weight_) <= kEditStep ? 1 : weight_ + kEditStep / apart;
  contact.force = old + weight_ * (contact.force - old);
  // What the device holds, for the ledgers of both.
  memory_.tip.applied = next_memory_.tip.applied = contact.force;
  if (weight_ < 1) return contact;
  felt_ = next_;
  memory_ = next_memory_;
  fading_ = false;
  return contact;
}

} // namespace patina
