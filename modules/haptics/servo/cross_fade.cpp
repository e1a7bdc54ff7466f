#include "haptics/servo/cross_fade.h"

namespace patina {
namespace {

Contact lawTick(const HapticSnapshot* law, ContactMemory& memory, const Vec3& tip,
                double dt) noexcept {
  if (law) return tick(*law, memory, tip, dt);
  Contact nothing;
  nothing.tip = nothing.frictionless_point = nothing.vcp = nothing.surface = tip;
  return nothing;
}

} // namespace

void CrossFade::fadeTo(const HapticSnapshot* next) noexcept {
  if (next == active_) return;
  next_ = next;
  fading_ = true;
  weight_ = 0;
  next_memory_ = memory_;
  if (!active_ || !next) next_memory_.leaveContact();
  if (!active_) next_memory_.tip.last.reset(); // the tip was not tracked
  next_memory_.changeLaw();
}

Contact CrossFade::tick(const Vec3& tip, double dt) noexcept {
  if (!fading_) return lawTick(active_, memory_, tip, dt);
  const Vec3 old = lawTick(active_, memory_, tip, dt).force;
  Contact contact = lawTick(next_, next_memory_, tip, dt);
  const double apart = (contact.force - old).norm();
  weight_ = apart * (1 - weight_) <= kEditStep ? 1 : weight_ + kEditStep / apart;
  contact.force = old + weight_ * (contact.force - old);
  // Force applied by the device, for both energy observers.
  memory_.tip.applied = next_memory_.tip.applied = contact.force;
  if (weight_ < 1) return contact;
  active_ = next_;
  memory_ = next_memory_;
  fading_ = false;
  return contact;
}

} // namespace patina
