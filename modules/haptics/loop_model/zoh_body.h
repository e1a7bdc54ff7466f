// Parts of a simulated device in three axes: exactly integrated mass, force delay, encoder.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {

// The same oscillator on each axis; dry friction acts per axis.
class ZohBody {
 public:
  explicit ZohBody(const Oscillator& axis, double dt = 1e-3); // throws as ZohIntegrator

  std::array<Motion, 3> axes{}; // relative to the springs' rest
  Vec3 position() const noexcept { return {axes[0].x, axes[1].x, axes[2].x}; }
  Vec3 velocity() const noexcept { return {axes[0].v, axes[1].v, axes[2].v}; }
  // Applies a constant force [N] for dt >= 0 [s] and returns the displacement.
  Vec3 advance(const Vec3& force, double dt) noexcept;

 private:
  ZohIntegrator step_;
};

// Delays forces by whole ticks; the first ones are zero.
class DelayLine {
 public:
  explicit DelayLine(int ticks) : forces_(static_cast<std::size_t>(ticks), Vec3::Zero()) {}
  Vec3 exchange(const Vec3& force) noexcept;

 private:
  std::vector<Vec3> forces_;
  std::size_t next_ = 0;
};

// Rounds to the encoder's resolution [m]; 0: exact.
Vec3 encoded(const Vec3& position, double step) noexcept;

} // namespace patina
