#include "haptics/devices/tip_target.h"

#include <stdexcept>

#include "haptics/devices/exact_step.h"

namespace patina {
namespace {

// Pointer events come every 8 to 16 ms; following slower than that hides their steps.
constexpr double kFollowTime = 0.015; // [s]

} // namespace

TipTarget::TipTarget(const Vec3& start) {
  if (!start.allFinite()) throw std::invalid_argument("tip target: the start must be finite");
  set(start);
}

void TipTarget::set(const Vec3& world) noexcept {
  if (!world.allFinite()) return;
  // The version is odd while the numbers change.
  const std::uint64_t version = version_.load(std::memory_order_relaxed);
  version_.store(version + 1, std::memory_order_seq_cst);
  for (std::size_t i = 0; i < 3; ++i)
    value_[i].store(world[static_cast<int>(i)], std::memory_order_seq_cst);
  version_.store(version + 2, std::memory_order_seq_cst);
}

void TipTarget::read(Vec3& world) const noexcept {
  const std::uint64_t before = version_.load(std::memory_order_seq_cst);
  Vec3 seen;
  for (std::size_t i = 0; i < 3; ++i)
    seen[static_cast<int>(i)] = value_[i].load(std::memory_order_seq_cst);
  if (before % 2 == 0 && version_.load(std::memory_order_seq_cst) == before) world = seen;
}

GlidingTip::GlidingTip(std::shared_ptr<const TipTarget> target, double max_speed)
    : target_(std::move(target)), max_speed_(max_speed) {
  if (!target_ || !(max_speed > 0))
    throw std::invalid_argument("gliding tip: it needs a target and a speed above 0");
  target_->read(goal_);
  tip_ = goal_;
}

const Vec3& GlidingTip::follow(double dt) noexcept {
  target_->read(goal_);
  Vec3 move = (goal_ - tip_) * masslessShare(kFollowTime, dt);
  const double longest = max_speed_ * dt;
  const double length = move.norm();
  if (length > longest) move *= longest / length;
  return tip_ += move;
}

} // namespace patina
