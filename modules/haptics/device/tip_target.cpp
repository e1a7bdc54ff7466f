#include "haptics/device/tip_target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

// Pointer events arrive every 8 to 16 ms; a slower response hides their steps.
constexpr double kFollowTime = 0.015; // [s]
constexpr double kLate = 0.002;       // [s]; smaller delays are caught up
constexpr double kStep = 0.020;       // [s]; a longer interval means that the pointer was at rest

} // namespace

TipTarget::TipTarget(const Vec3& start) {
  if (!start.allFinite()) throw std::invalid_argument("tip target: the start must be finite");
  set(start);
}

void TipTarget::set(const Vec3& world) noexcept {
  if (!world.allFinite()) return;
  // The version is odd during a write (sequence lock, Boehm 2012).
  const std::uint64_t version = version_.load(std::memory_order_relaxed);
  version_.store(version + 1, std::memory_order_seq_cst);
  for (std::size_t i = 0; i < 3; ++i)
    value_[i].store(world[static_cast<int>(i)], std::memory_order_seq_cst);
  version_.store(version + 2, std::memory_order_seq_cst);
}

void TipTarget::addWaypoint(const Vec3& world, double t) noexcept {
  push({world, t, version_.load(std::memory_order_relaxed), false});
}

void TipTarget::jumpTo(const Vec3& world, double t) noexcept {
  push({world, t, version_.load(std::memory_order_relaxed), true});
}

void TipTarget::push(const Waypoint& waypoint) noexcept {
  if (!waypoint.world.allFinite() || !std::isfinite(waypoint.t)) return;
  if (path_.push(waypoint)) asked_.fetch_add(1, std::memory_order_release);
}

bool TipTarget::allReached() const noexcept {
  return passed_.load(std::memory_order_acquire) == asked_.load(std::memory_order_relaxed);
}

std::uint64_t TipTarget::read(Vec3& world) const noexcept {
  const std::uint64_t before = version_.load(std::memory_order_seq_cst);
  Vec3 seen;
  for (std::size_t i = 0; i < 3; ++i)
    seen[static_cast<int>(i)] = value_[i].load(std::memory_order_seq_cst);
  if (before % 2 != 0 || version_.load(std::memory_order_seq_cst) != before) return 0;
  world = seen;
  return before;
}

bool TipTarget::next(Waypoint& waypoint) const noexcept {
  return path_.pop(waypoint);
}

bool TipTarget::isNewest() const noexcept {
  return passed_.load(std::memory_order_relaxed) + 1 == asked_.load(std::memory_order_acquire);
}

void TipTarget::setReached() const noexcept {
  passed_.fetch_add(1, std::memory_order_release);
}

SpeedLimitedTip::SpeedLimitedTip(std::shared_ptr<const TipTarget> target, double max_speed,
                                 bool can_jump)
    : target_(std::move(target)), can_jump_(can_jump), max_speed_(max_speed) {
  if (!target_ || !(max_speed > 0))
    throw std::invalid_argument("speed-limited tip: it needs a target and a speed above 0");
  version_ = target_->read(goal_);
  tip_ = goal_;
}

// After a rest of the pointer only the last segment counts as motion. A segment starts now if its
// waypoint arrived late or is the newest, because the servo's clock may lag behind the pointer's.
bool SpeedLimitedTip::take() noexcept {
  TipTarget::Waypoint next;
  do {
    if (!target_->next(next)) return false;
    if (next.version < version_) target_->setReached(); // superseded by set()
  } while (next.version < version_);
  version_ = next.version;
  if (next.jumps) on_path_ = false; // a new path starts without waiting for its time
  if (next.jumps && can_jump_) {
    tip_ = next.world;
    lift_ = kJumpTime;
  }
  const double before = on_path_ ? to_.t : -std::numeric_limits<double>::infinity();
  from_ = tip_;
  to_ = next;
  to_.t = std::max(to_.t, before);
  leaves_ =
      std::min(std::max(before, to_.t - kStep), to_.t - (to_.world - from_).norm() / max_speed_);
  const bool rests = now_ < leaves_ && !target_->isNewest();
  if (!on_path_ || now_ > leaves_ + kLate || (now_ < leaves_ && !rests)) now_ = leaves_;
  return on_path_ = on_leg_ = true;
}

const Vec3& SpeedLimitedTip::follow(double dt) noexcept {
  if (const std::uint64_t version = target_->read(goal_); version > version_) {
    version_ = version;
    if (std::exchange(on_leg_, false)) target_->setReached();
    on_path_ = false;
  }
  lift_ -= std::min(lift_, dt);
  if (lifted()) return tip_;
  now_ += dt;
  while (on_leg_ || take()) {
    if (lifted()) return tip_;
    if (now_ < to_.t) {
      const double part = std::max(0.0, (now_ - leaves_) / (to_.t - leaves_));
      return tip_ = from_ + part * (to_.world - from_);
    }
    tip_ = to_.world;
    on_leg_ = false;
    target_->setReached();
    if (now_ < to_.t + dt) return tip_; // one tick per waypoint, so that no corner is cut
  }
  if (on_path_) return tip_;
  Vec3 move = (goal_ - tip_) * firstOrderFraction(kFollowTime, dt);
  const double longest = max_speed_ * dt;
  const double length = move.norm();
  if (length > longest) move *= longest / length;
  return tip_ += move;
}

} // namespace patina
