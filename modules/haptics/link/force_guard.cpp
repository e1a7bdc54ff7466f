#include "haptics/link/force_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptics/law/limit_stage.h"

namespace patina {
namespace {

constexpr double kWarm = 0.8; // heat above which the force is reduced

} // namespace

const char* text(ForceInhibit inhibit) noexcept {
  switch (inhibit) {
  case ForceInhibit::none:
    return "nothing inhibits it";
  case ForceInhibit::device:
    return "the device does not answer as it should";
  case ForceInhibit::servo:
    return "the servo is late";
  case ForceInhibit::ui_timeout:
    return "the window does not respond";
  case ForceInhibit::command:
    return "the requested force is not a number";
  case ForceInhibit::deadman_released:
    break;
  }
  return "the enabling button is not held";
}

ForceGuard::ForceGuard(const GuardSpec& spec) : spec_(spec) {
  if (!(spec.max_force > 0 && spec.motors.continuous > 0 && spec.motors.time_constant > 0 &&
        spec.max_command_age > 0 && spec.max_heartbeat_age > 0 && spec.ramp > 0 &&
        spec.weight.allFinite()))
    throw std::invalid_argument("force guard: limits, ramp and times must be above 0");
  if (std::isfinite(spec.motors.continuous) && std::isinf(spec.max_force))
    throw std::invalid_argument("force guard: motors with a thermal limit need max_force");
}

ForceInhibit ForceGuard::inhibitFor(const ForceRequest& asked,
                                    const DeviceState& reading) const noexcept {
  if (effectiveStatus(reading) != DeviceStatus::ok || !reading.position.allFinite())
    return ForceInhibit::device;
  if (!(asked.command_age <= spec_.max_command_age)) return ForceInhibit::servo;
  if (!(asked.heartbeat_age <= spec_.max_heartbeat_age)) return ForceInhibit::ui_timeout;
  if (!asked.force.allFinite()) return ForceInhibit::command;
  if (asked.requires_deadman && reading.buttons == 0) return ForceInhibit::deadman_released;
  return ForceInhibit::none;
}

double ForceGuard::maxNow() const noexcept {
  const double lasting = std::min(spec_.max_force, spec_.motors.continuous);
  const double warm = std::clamp((heat_ - kWarm) / (1 - kWarm), 0.0, 1.0);
  return warm > 0 ? spec_.max_force + warm * (lasting - spec_.max_force) : spec_.max_force;
}

Vec3 ForceGuard::limit(const ForceRequest& asked, const DeviceState& reading, double dt) noexcept {
  inhibit_ = inhibitFor(asked, reading);
  dt = dt > 0 ? std::min(dt, 1.0) : 0;
  gain_ =
      inhibit_ == ForceInhibit::none ? std::min(1.0, gain_ + std::min(dt, 0.01) / spec_.ramp) : 0;
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
    force = gain_ * scaledTo(force, maxNow());
  }
  if (!std::isfinite(spec_.motors.continuous)) return force;
  // Exact step of dheat/dt = (load^2 - heat) / time_constant.
  const double load = force.norm() / spec_.motors.continuous;
  const double part = -std::expm1(-dt / spec_.motors.time_constant);
  heat_ += part * (load * load - heat_);
  return force;
}

} // namespace patina
