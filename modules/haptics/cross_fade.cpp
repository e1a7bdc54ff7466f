#include "haptics/cross_fade.h"

namespace patina {

void CrossFade::turnTo(const HapticSnapshot* next) noexcept {
  if (next == felt_) return;
  if (!felt_ || !next) {
    felt_ = next;
    memory_.reset();
    return;
  }
  next_ = next;
  weight_ = 0;
  next_memory_ = memory_;
  if (next->field != felt_->field) next_memory_.leaveContact();
  // What the old law measured is not the new one's: neither its force nor its clearance.
  next_memory_.has_last_raw = false;
  next_memory_.clearance = std::numeric_limits<double>::infinity();
}

Contact CrossFade::tick(const Vec3& tip, double dt) noexcept {
  if (!felt_) {
    Contact none;
    none.tip = none.candidate = none.vcp = none.surface = tip;
    return none;
  }
  if (!next_) return patina::tick(*felt_, memory_, tip, dt);
  const Vec3 old = patina::tick(*felt_, memory_, tip, dt).force;
  Contact contact = patina::tick(*next_, next_memory_, tip, dt);
  const double apart = (contact.force - old).norm();
  weight_ = apart * (1 - weight_) <= kEditStep ? 1 : weight_ + kEditStep / apart;
  contact.force = old + weight_ * (contact.force - old);
  if (weight_ < 1) return contact;
  felt_ = next_;
  memory_ = next_memory_;
  next_ = nullptr;
  return contact;
}

} // namespace patina
