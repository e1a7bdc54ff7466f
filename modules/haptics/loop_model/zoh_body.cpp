#include "haptics/loop_model/zoh_body.h"

namespace patina {

ZohBody::ZohBody(const Oscillator& axis, double dt) : step_(axis, dt) {}

Vec3 ZohBody::advance(const Vec3& force, double dt) noexcept {
  step_.setLength(dt);
  Vec3 moved;
  for (int i = 0; i < 3; ++i) {
    Motion& axis = axes[static_cast<std::size_t>(i)];
    const double from = axis.x;
    axis = step_(axis, force[i]);
    moved[i] = axis.x - from;
  }
  return moved;
}

Vec3 DelayLine::exchange(const Vec3& force) noexcept {
  if (forces_.empty()) return force;
  const Vec3 due = forces_[next_];
  forces_[next_] = force;
  next_ = (next_ + 1) % forces_.size();
  return due;
}

Vec3 encoded(const Vec3& position, double step) noexcept {
  if (!(step > 0)) return position;
  return step * (position / step).array().round().matrix();
}

} // namespace patina
