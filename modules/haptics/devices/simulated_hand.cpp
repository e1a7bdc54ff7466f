#include "haptics/devices/simulated_hand.h"

#include <stdexcept>

#include "haptics/devices/held_body.h"
#include "haptics/stages/limit_stage.h"

namespace patina {
namespace {

const DeviceModel& checked(const DeviceModel& device) {
  if (device.delay < 0 || device.delay > kMaxDelay)
    throw std::invalid_argument("simulated hand: delay out of range");
  return device;
}

class SimulatedHand final : public Device {
 public:
  SimulatedHand(std::shared_ptr<const TipTarget> target, const HandSpec& spec)
      : spec_(spec), hand_(std::move(target)), start_(hand_.position()),
        delay_(checked(spec.device).delay),
        body_({spec.device.mass, spec.device.damping + spec.damping, 0, spec.device.coulomb}) {}

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const Vec3 pull = spec_.stiffness * (hand_.follow(dt) - position());
    body_.hold(delay_.exchange(force) + scaledTo(pull, spec_.max_force), dt);
    return {encoded(position(), spec_.device.encoder_step)};
  }

 private:
  Vec3 position() const noexcept { return start_ + body_.position(); }

  HandSpec spec_;
  GlidingTip hand_; // where the hand is: it glides as the mouse does
  Vec3 start_;
  DelayLine delay_;
  HeldBody body_;
};

class Mouse final : public Device {
 public:
  Mouse(std::shared_ptr<const TipTarget> target, double max_speed)
      : tip_(std::move(target), max_speed, true) {}
  DeviceState exchange(const Vec3&, double dt) noexcept override {
    DeviceState state{tip_.follow(dt)};
    if (tip_.lifted()) state.status = DeviceStatus::lifted;
    return state;
  }

 private:
  GlidingTip tip_;
};

} // namespace

std::unique_ptr<Device> makeSimulatedHand(std::shared_ptr<const TipTarget> target,
                                          const HandSpec& spec) {
  return std::make_unique<SimulatedHand>(std::move(target), spec);
}

std::unique_ptr<Device> makeMouse(std::shared_ptr<const TipTarget> target, double max_speed) {
  return std::make_unique<Mouse>(std::move(target), max_speed);
}

} // namespace patina
