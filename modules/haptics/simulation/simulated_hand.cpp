#include "haptics/simulation/simulated_hand.h"

#include <cmath>
#include <stdexcept>

#include "haptics/law/limit_stage.h"
#include "haptics/loop_model/zoh_body.h"

namespace patina {
namespace {

class ReplayedHand final : public Device {
 public:
  explicit ReplayedHand(std::vector<TimedTip> path) : path_(std::move(path)) {
    const auto refuse = [](bool wrong, const char* what) {
      if (wrong) throw std::invalid_argument(std::string("replayed hand: ") + what);
    };
    refuse(path_.empty(), "no rows");
    for (std::size_t i = 0; i < path_.size(); ++i) {
      refuse(!path_[i].tip.allFinite() || !std::isfinite(path_[i].t), "a row is not finite");
      refuse(i > 0 && path_[i].t <= path_[i - 1].t, "t must increase");
    }
    t_ = path_.front().t;
  }

  DeviceState exchange(const Vec3&, double dt) noexcept override {
    t_ += dt;
    while (next_ < path_.size() && path_[next_].t <= t_) ++next_;
    if (next_ == path_.size()) return {path_.back().tip};
    const TimedTip& from = path_[next_ - 1];
    const TimedTip& to = path_[next_];
    return {from.tip + (t_ - from.t) / (to.t - from.t) * (to.tip - from.tip)};
  }

 private:
  std::vector<TimedTip> path_;
  std::size_t next_ = 1; // the first row that lies ahead
  double t_ = 0;
};

} // namespace

std::unique_ptr<Device> makeReplayedHand(std::vector<TimedTip> path) {
  return std::make_unique<ReplayedHand>(std::move(path));
}

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
    body_.advance(delay_.exchange(force) + scaledTo(pull, spec_.max_force), dt);
    return {encoded(position(), spec_.device.encoder_step)};
  }

 private:
  Vec3 position() const noexcept { return start_ + body_.position(); }

  HandSpec spec_;
  SpeedLimitedTip hand_; // position of the hand, speed-limited like the mouse
  Vec3 start_;
  DelayLine delay_;
  ZohBody body_;
};

class Mouse final : public Device {
 public:
  Mouse(std::shared_ptr<const TipTarget> target, double max_speed)
      : tip_(std::move(target), max_speed, true) {}
  DeviceState exchange(const Vec3&, double dt) noexcept override {
    DeviceState state{tip_.follow(dt)};
    if (tip_.lifted()) state.status = DeviceStatus::repositioning;
    return state;
  }

 private:
  SpeedLimitedTip tip_;
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
