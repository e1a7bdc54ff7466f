#include "haptics/devices/link/force_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptics/stages/limit_stage.h"

namespace patina {
namespace {

constexpr double kWarm = 0.8; // of the heat: from here on less force is given

} // namespace

const char* text(Hold hold) noexcept {
  switch (hold) {
  case Hold::none:
    return "none is held back";
  case Hold::device:
    return "the device does not answer as it should";
  case Hold::servo:
    return "the servo is late";
  case Hold::window:
    return "the window does not respond";
  case Hold::command:
    return "what was asked for is no number";
  case Hold::let_go:
    break;
  }
  return "the button that allows it is not held";
}

ForceGuard::ForceGuard(const GuardSpec& spec) : spec_(spec) {
  if (!(spec.max_force > 0 && spec.motors.continuous > 0 && spec.motors.time_constant > 0 &&
        spec.oldest_command > 0 && spec.oldest_look > 0 && spec.ramp > 0 &&
        spec.weight.allFinite()))
    throw std::invalid_argument("force guard: limits, ramp and times must be above 0");
  if (std::isfinite(spec.motors.continuous) && std::isinf(spec.max_force))
    throw std::invalid_argument("force guard: motors that warm need a greatest force");
}

Hold ForceGuard::holdFor(const Asked& asked, const DeviceState& reading) const noexcept {
  if (judge(reading) != DeviceStatus::ok || !reading.position.allFinite()) return Hold::device;
  if (!(asked.command_age <= spec_.oldest_command)) return Hold::servo;
  if (!(asked.look_age <= spec_.oldest_look)) return Hold::window;
  if (!asked.force.allFinite()) return Hold::command;
  if (asked.needs_button && reading.buttons == 0) return Hold::let_go;
  return Hold::none;
}

double ForceGuard::mostNow() const noexcept {
  const double lasting = std::min(spec_.max_force, spec_.motors.continuous);
  const double warm = std::clamp((heat_ - kWarm) / (1 - kWarm), 0.0, 1.0);
  return warm > 0 ? spec_.max_force + warm * (lasting - spec_.max_force) : spec_.max_force;
}

Vec3 ForceGuard::pass(const Asked& asked, const DeviceState& reading, double dt) noexcept {
  hold_ = holdFor(asked, reading);
  dt = dt > 0 ? std::min(dt, 1.0) : 0;
  gain_ = hold_ == Hold::none ? std::min(1.0, gain_ + std::min(dt, 0.01) / spec_.ramp) : 0;
  Vec3 force = Vec3::Zero();
  if (gain_ > 0) {
    force = asked.force + spec_.weight;
    if (spec_.workspace)
      for (int i = 0; i < 3; ++i) {
        const double over = reading.position[i] - spec_.workspace->max()[i];
        const double under = spec_.workspace->min()[i] - reading.position[i];
        const bool pushes_out = (over > 0 && force[i] > 0) || (under > 0 && force[i] < 0);
        if (pushes_out) force[i] *= std::max(0.0, 1 - std::max(over, under) / kWorkspaceEdge);
      }
    force = gain_ * scaledTo(force, mostNow());
  }
  if (!std::isfinite(spec_.motors.continuous)) return force;
  // The exact step of dheat/dt = (load^2 - heat) / time_constant.
  const double load = force.norm() / spec_.motors.continuous;
  const double part = -std::expm1(-dt / spec_.motors.time_constant);
  heat_ += part * (load * load - heat_);
  return force;
}

} // namespace patina
