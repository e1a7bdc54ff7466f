#include "app/gui/servo/hand_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "haptics/contact/contact.h"
#include "haptics/devices/exact_step.h"

namespace patina {
namespace {

class HandDevice final : public MouseDevice {
 public:
  HandDevice(const Vec3& start, const HandSpec& spec)
      : spec_(spec), hand_(makeMouseDevice(start)), position_(start) {
    if (spec.device.delay < 0 || spec.device.delay > kMaxDelay || !(spec.device.mass > 0))
      throw std::invalid_argument("hand device: mass or delay out of range");
    on_their_way_.fill(Vec3::Zero());
  }

  void setTarget(const Vec3& world) noexcept override { hand_->setTarget(world); }

  Vec3 exchange(const Vec3& force, double dt) noexcept override {
    newest_ = (newest_ + 1) % on_their_way_.size();
    on_their_way_[newest_] = force;
    const std::size_t arrived =
        (newest_ + on_their_way_.size() - static_cast<std::size_t>(spec_.device.delay)) %
        on_their_way_.size();

    Vec3 pull = spec_.stiffness * (hand_->exchange(Vec3::Zero(), dt) - position_);
    const double size = pull.norm();
    if (size > spec_.max_force) pull *= spec_.max_force / size;
    const HeldStep step =
        heldStep({spec_.device.mass, spec_.device.damping + spec_.damping, 0, 0}, dt);
    const Vec3 total = withFriction(on_their_way_[arrived] + pull, dt);
    position_ += step.xv * velocity_ + step.xf * total;
    velocity_ = step.vv * velocity_ + step.vf * total;
    return read();
  }

 private:
  // Coulomb's friction, held over the step too: never more than what would stop it within the step.
  Vec3 withFriction(const Vec3& total, double dt) const noexcept {
    if (!(spec_.device.coulomb > 0) || !(dt > 0)) return total;
    const Vec3 stopping = total + spec_.device.mass / dt * velocity_;
    const double size = stopping.norm();
    if (size <= spec_.device.coulomb) return total - stopping;
    return total - spec_.device.coulomb / size * stopping;
  }
  Vec3 read() const noexcept {
    const double step = spec_.device.encoder_step;
    if (!(step > 0)) return position_;
    return step * (position_ / step).array().round().matrix();
  }

  HandSpec spec_;
  std::unique_ptr<MouseDevice> hand_; // where the hand is: it glides as the mouse does
  Vec3 position_;
  Vec3 velocity_ = Vec3::Zero();
  std::array<Vec3, kMaxDelay + 1> on_their_way_; // forces that have not arrived, a ring
  std::size_t newest_ = 0;
};

} // namespace

std::unique_ptr<MouseDevice> makeHandDevice(const Vec3& start, const HandSpec& spec) {
  return std::make_unique<HandDevice>(start, spec);
}

} // namespace patina
