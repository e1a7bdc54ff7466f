#include "haptics/devices/device.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace patina {
namespace {

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

  Vec3 exchange(const Vec3&, double dt) noexcept override {
    target_.read(goal_);
    Vec3 move = (goal_ - tip_) * -std::expm1(-dt / kFollowTime);
    const double longest = max_speed_ * dt;
    const double length = move.norm();
    if (length > longest) move *= longest / length;
    tip_ += move;
    return tip_;
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

std::unique_ptr<MouseDevice> makeMouseDevice(const Vec3& start, double max_speed) {
  return std::make_unique<GlidingMouse>(start, max_speed);
}

} // namespace patina
