// What a simulated device is made of, in three axes: a mass moved exactly, forces on their way to
// it, an encoder.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"
#include "haptics/devices/exact_step.h"

namespace patina {

// The same oscillator along each axis; dry friction acts on each by itself.
class HeldBody {
 public:
  explicit HeldBody(const Oscillator& axis, double dt = 1e-3); // throws as ExactStep

  std::array<Motion, 3> axes{}; // from the springs' rest
  Vec3 position() const noexcept { return {axes[0].x, axes[1].x, axes[2].x}; }
  Vec3 velocity() const noexcept { return {axes[0].v, axes[1].v, axes[2].v}; }
  // Under a force [N] held for dt >= 0 [s]; returns how far it went. Cheapest where dt stays.
  Vec3 hold(const Vec3& force, double dt) noexcept;

 private:
  ExactStep step_;
};

// Whole ticks between a force that is sent and the same force that acts; before, none acts.
class DelayLine {
 public:
  explicit DelayLine(int ticks) : forces_(static_cast<std::size_t>(ticks), Vec3::Zero()) {}
  Vec3 exchange(const Vec3& force) noexcept;

 private:
  std::vector<Vec3> forces_;
  std::size_t next_ = 0;
};

// What an encoder of this resolution [m] reads; 0: exact.
Vec3 encoded(const Vec3& position, double step) noexcept;

} // namespace patina
