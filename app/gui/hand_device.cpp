#include "app/gui/hand_device.h"

namespace patina {
namespace {

class HandDevice final : public MouseDevice {
 public:
  HandDevice(const Vec3& start, const HandSpec& spec)
      : spec_(spec), hand_(makeMouseDevice(start)), position_(start) {}

  void setTarget(const Vec3& world) noexcept override { hand_->setTarget(world); }

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    Vec3 pull = spec_.stiffness * (hand_->exchange(Vec3::Zero(), dt).tip - position_);
    const double size = pull.norm();
    if (size > spec_.max_force) pull *= spec_.max_force / size;
    const HeldForceStep step = heldForceStep(spec_.mass, spec_.damping, dt);
    const Vec3 total = force + pull;
    position_ += step.c * velocity_ + step.d * total;
    velocity_ = step.a * velocity_ + step.e * total;
    return {position_, false, false};
  }

  DeviceInfo info() const override {
    return {"simulated hand", 0, 0, "a mass on a spring and a damper towards the mouse"};
  }

 private:
  HandSpec spec_;
  std::unique_ptr<MouseDevice> hand_; // where the hand is: it glides as the mouse does
  Vec3 position_;
  Vec3 velocity_ = Vec3::Zero();
};

} // namespace

std::unique_ptr<MouseDevice> makeHandDevice(const Vec3& start, const HandSpec& spec) {
  return std::make_unique<HandDevice>(start, spec);
}

} // namespace patina
