// Target of a pointer-driven tip, passed from the window's thread to the servo's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/ring.h"
#include "core/types.h"
#include "haptics/device/device.h"

namespace patina {

// Exceeds the pause of a recording, so that a replay has no contact there either.
inline constexpr double kJumpTime = 1.25 * kMaxStateAge; // [s]

// A position, or timed waypoints of a pointer. No call blocks. One thread at a time may call set(),
// addWaypoint(), jumpTo() and allReached(), the servo the others. Ignores non-finite values.
class TipTarget {
 public:
  explicit TipTarget(const Vec3& start); // throws std::invalid_argument if `start` is not finite
  void set(const Vec3& world) noexcept;  // at once; discards pending waypoints
  // Appends a waypoint with its pointer time t [s], which keeps the hand's motion in long frames.
  void addWaypoint(const Vec3& world, double t) noexcept;
  // Appends a waypoint that the lifted tip reaches kJumpTime later, without contact on its way.
  void jumpTo(const Vec3& world, double t) noexcept;
  bool allReached() const noexcept; // no waypoint is pending

  struct Waypoint {
    Vec3 world = Vec3::Zero();
    double t = 0;
    std::uint64_t version = 0; // version of the position set before
    bool jumps = false;
  };
  // Returns the version of the position; 0 during a concurrent write, `world` is then unchanged.
  std::uint64_t read(Vec3& world) const noexcept;
  bool next(Waypoint& waypoint) const noexcept; // false: no waypoint is pending
  bool isNewest() const noexcept;               // no waypoint follows the last one taken
  void setReached() const noexcept;             // counts a waypoint as reached

 private:
  void push(const Waypoint& waypoint) noexcept;

  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<double>, 3> value_{};
  mutable Ring<Waypoint> path_{4096};
  std::atomic<std::uint64_t> asked_{0};
  mutable std::atomic<std::uint64_t> passed_{0};
};

// Follows a target at no more than max_speed, so that a jump of the pointer is no jump of the tip.
// Visits each waypoint of a path, one pointer step later.
class SpeedLimitedTip {
 public:
  // Starts at the target. Throws std::invalid_argument without one, or unless max_speed [m/s] is
  // positive. can_jump: false for a body with mass, which moves instead of jumping.
  explicit SpeedLimitedTip(std::shared_ptr<const TipTarget> target, double max_speed = 1.0,
                           bool can_jump = false);
  const Vec3& follow(double dt) noexcept; // returns the position dt later
  const Vec3& position() const noexcept { return tip_; }
  bool lifted() const noexcept { return lift_ > 0; } // jumping

 private:
  bool take() noexcept; // starts the next segment of the path

  std::shared_ptr<const TipTarget> target_;
  Vec3 goal_ = Vec3::Zero();
  std::uint64_t version_ = 0; // version of the goal
  Vec3 tip_;
  bool can_jump_;
  double lift_ = 0; // remaining time of the jump [s]
  double max_speed_;
  // on_leg_: on a segment of the path; on_path_: also at its end.
  bool on_path_ = false, on_leg_ = false;
  Vec3 from_ = Vec3::Zero();
  TipTarget::Waypoint to_;
  double leaves_ = 0, now_ = 0; // pointer times at which the segment begins and now [s]
};

} // namespace patina
