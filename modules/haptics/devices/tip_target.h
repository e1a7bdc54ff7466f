// What a pointer moves: where the tip shall go, from the window's thread to the servo's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/types.h"

namespace patina {

// Three numbers that never tear; neither side ever waits.
class TipTarget {
 public:
  explicit TipTarget(const Vec3& start); // throws std::invalid_argument if it is not finite
  void set(const Vec3& world) noexcept;  // one thread at a time; what is not finite is ignored
  void read(Vec3& world) const noexcept; // leaves it as it is where it meets a write

 private:
  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<double>, 3> value_{};
};

// A point that glides to a target at no more than max_speed, so that a jump of the pointer is not a
// jump of the tip.
class GlidingTip {
 public:
  // Begins at the target. Throws std::invalid_argument without one, or if max_speed [m/s] is not
  // above 0.
  explicit GlidingTip(std::shared_ptr<const TipTarget> target, double max_speed = 1.0);
  const Vec3& follow(double dt) noexcept; // where it is dt later
  const Vec3& position() const noexcept { return tip_; }

 private:
  std::shared_ptr<const TipTarget> target_;
  Vec3 goal_ = Vec3::Zero();
  Vec3 tip_;
  double max_speed_;
};

} // namespace patina
