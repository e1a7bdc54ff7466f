// What a pointer moves: where the tip shall go, from the window's thread to the servo's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/ring.h"
#include "core/types.h"
#include "haptics/devices/device.h"

namespace patina {

// As long as makes a pause of a recording, so that what is replayed is lifted, too.
inline constexpr double kLeapTime = 1.25 * kOldestAge; // [s]

// A place, or places with the times at which a pointer was there. Neither side ever waits. set(),
// pass(), leap() and passed() are one thread's at a time, the rest is the servo's; what is not
// finite is ignored.
class TipTarget {
 public:
  explicit TipTarget(const Vec3& start); // throws std::invalid_argument if it is not finite
  void set(const Vec3& world) noexcept;  // at once: what was to be passed is forgotten
  // After those before, as much later as t [s] says, whenever it is told: pointer events that a
  // long frame has held up are still followed as the hand moved.
  void pass(const Vec3& world, double t) noexcept;
  // As pass(), but the tip is lifted off and comes down there kLeapTime later: nothing is felt on
  // the way.
  void leap(const Vec3& world, double t) noexcept;
  bool passed() const noexcept; // the tip has been at all of them

  struct Waypoint {
    Vec3 world = Vec3::Zero();
    double t = 0;
    std::uint64_t version = 0; // of the place that was set before
    bool leaps = false;
  };
  // The version of the place; 0 where it meets a write, and world stays.
  std::uint64_t read(Vec3& world) const noexcept;
  bool next(Waypoint& waypoint) const noexcept; // false: none waits
  bool isNewest() const noexcept;               // what was taken last; none waits behind it
  void setPassed() const noexcept;              // one more of them

 private:
  void push(const Waypoint& waypoint) noexcept;

  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<double>, 3> value_{};
  mutable Ring<Waypoint> path_{4096};
  std::atomic<std::uint64_t> asked_{0};
  mutable std::atomic<std::uint64_t> passed_{0};
};

// A point that glides to a target at no more than max_speed, so that a jump of the pointer is not a
// jump of the tip. A path it follows corner by corner, a pointer's step later.
class GlidingTip {
 public:
  // Begins at the target. Throws std::invalid_argument without one, or if max_speed [m/s] is not
  // above 0. What has a mass does not leap, but glides there too.
  explicit GlidingTip(std::shared_ptr<const TipTarget> target, double max_speed = 1.0,
                      bool leaps = false);
  const Vec3& follow(double dt) noexcept; // where it is dt later
  const Vec3& position() const noexcept { return tip_; }
  bool lifted() const noexcept { return lift_ > 0; } // it leaps

 private:
  bool take() noexcept; // the next leg of the path

  std::shared_ptr<const TipTarget> target_;
  Vec3 goal_ = Vec3::Zero();
  std::uint64_t version_ = 0; // of the goal
  Vec3 tip_;
  bool leaps_;
  double lift_ = 0; // [s] that it is lifted still
  double max_speed_;
  // On a path: the leg that it is on, or that it has come to the end of.
  bool on_path_ = false, on_leg_ = false;
  Vec3 from_ = Vec3::Zero();
  TipTarget::Waypoint to_;
  double leaves_ = 0, now_ = 0; // [s], of the pointer's time
};

} // namespace patina
