#include "haptics/device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace patina {
namespace {

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(const SimulatedDeviceSpec& spec) : spec_(spec) {
    if (!(spec.mass > 0) || !(spec.damping >= 0) || !std::isfinite(spec.mass + spec.damping)) {
      throw std::invalid_argument("simulated device: mass must be > 0 and damping >= 0");
    }
  }

  DeviceState exchange(const Vec3& force, double dt) noexcept override {
    const HeldForceStep step = heldForceStep(spec_.mass, spec_.damping, dt);
    const Vec3 total = force + spec_.hand_force;
    spec_.position += step.c * spec_.velocity + step.d * total;
    spec_.velocity = step.a * spec_.velocity + step.e * total;
    return {spec_.position, false, false};
  }

  DeviceInfo info() const override {
    return {"simulated", 0, 0, "point mass with viscous damping, exact zero-order hold"};
  }

 private:
  SimulatedDeviceSpec spec_;
};

class ReplayDevice final : public Device {
 public:
  explicit ReplayDevice(std::vector<Vec3> tips) : tips_(std::move(tips)) {
    if (tips_.empty()) throw std::invalid_argument("replay device: the path is empty");
  }

  DeviceState exchange(const Vec3&, double) noexcept override {
    const std::size_t now = std::min(next_, tips_.size() - 1);
    if (next_ < tips_.size()) ++next_;
    return {tips_[now], false, next_ == tips_.size()};
  }

  DeviceInfo info() const override { return {"replay", 0, 0, "plays a recorded tip path"}; }

 private:
  std::vector<Vec3> tips_;
  std::size_t next_ = 0;
};

// A target of three numbers that never tears: the writer bumps the version around its stores; a
// reader that meets a write in progress keeps what it had, so neither side ever waits.
class TargetCell {
 public:
  explicit TargetCell(const Vec3& start) { write(start); }

  void write(const Vec3& value) noexcept {
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_seq_cst);
    for (std::size_t i = 0; i < 3; ++i) {
      value_[i].store(value[static_cast<int>(i)], std::memory_order_seq_cst);
    }
    version_.store(version + 2, std::memory_order_seq_cst);
  }

  void read(Vec3& value) const noexcept {
    const std::uint64_t before = version_.load(std::memory_order_seq_cst);
    Vec3 seen;
    for (std::size_t i = 0; i < 3; ++i) {
      seen[static_cast<int>(i)] = value_[i].load(std::memory_order_seq_cst);
    }
    if (before % 2 == 0 && version_.load(std::memory_order_seq_cst) == before) value = seen;
  }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<double>, 3> value_{};
};

class GlidingMouse final : public MouseDevice {
 public:
  GlidingMouse(const Vec3& start, double max_speed)
      : target_(start), goal_(start), tip_(start), max_speed_(max_speed) {
    if (!start.allFinite() || !(max_speed > 0)) {
      throw std::invalid_argument("mouse device: start must be finite and max_speed > 0");
    }
  }

  void setTarget(const Vec3& world) noexcept override {
    if (world.allFinite()) target_.write(world);
  }

  DeviceState exchange(const Vec3&, double dt) noexcept override {
    target_.read(goal_);
    Vec3 move = (goal_ - tip_) * -std::expm1(-dt / kFollowTime);
    const double longest = max_speed_ * dt;
    const double length = move.norm();
    if (length > longest) move *= longest / length;
    tip_ += move;
    return {tip_, false, false};
  }

  DeviceInfo info() const override {
    return {"mouse", 0, 0, "seen, not felt: the drawn tool is held out by the contact"};
  }

 private:
  // Pointer events come every 8 to 16 ms; following slower than that hides their steps.
  static constexpr double kFollowTime = 0.015; // [s]
  TargetCell target_;
  Vec3 goal_;
  Vec3 tip_;
  double max_speed_;
};

} // namespace

HeldForceStep heldForceStep(double mass, double damping, double dt) noexcept {
  const double x = damping * dt / mass;
  if (x < 1e-4) {
    // (1 - e^-x)/x and its integral lose their digits as x -> 0: their series to O(x^3).
    const double c = dt * (1 - x / 2 + x * x / 6);
    const double d = dt * dt / mass * (0.5 - x / 6 + x * x / 24);
    return {std::exp(-x), c, d, c / mass};
  }
  const double loss = -std::expm1(-x);
  const double c = loss * mass / damping;
  return {1 - loss, c, (dt - c) / damping, loss / damping};
}

std::unique_ptr<Device> makeSimulatedDevice(const SimulatedDeviceSpec& spec) {
  return std::make_unique<SimulatedDevice>(spec);
}

std::unique_ptr<Device> makeReplayDevice(std::vector<Vec3> tips) {
  return std::make_unique<ReplayDevice>(std::move(tips));
}

std::unique_ptr<MouseDevice> makeMouseDevice(const Vec3& start, double max_speed) {
  return std::make_unique<GlidingMouse>(start, max_speed);
}

} // namespace patina
