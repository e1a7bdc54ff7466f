#include "app/gui/haptic_ramp.h"

#include <algorithm>

namespace patina {
namespace {

constexpr double kStiffnessFactor = 1.08;
constexpr double kRadiusStep = 0.5e-3; // [m]
constexpr double kDampingStep = 2;     // [N s/m]
constexpr double kFrictionStep = 0.2;

double stepped(double now, double wanted, double step) {
  return std::clamp(wanted, now - step, now + step);
}

std::optional<double> stepped(const std::optional<double>& now, const std::optional<double>& wanted,
                              double step) {
  const double next = stepped(now.value_or(0), wanted.value_or(0), step);
  if (!wanted && next <= 0) return std::nullopt;
  return next;
}

std::optional<Friction> stepped(const std::optional<Friction>& now,
                                const std::optional<Friction>& wanted) {
  const Friction from = now.value_or(Friction{});
  Friction to = wanted.value_or(Friction{});
  Friction next = to;
  next.static_coefficient = stepped(from.static_coefficient, to.static_coefficient, kFrictionStep);
  next.dynamic_coefficient =
      std::min(stepped(from.dynamic_coefficient, to.dynamic_coefficient, kFrictionStep),
               next.static_coefficient);
  if (!wanted && next.static_coefficient <= 0) return std::nullopt;
  return next;
}

bool same(const std::optional<Friction>& a, const std::optional<Friction>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->static_coefficient == b->static_coefficient &&
                a->dynamic_coefficient == b->dynamic_coefficient &&
                a->depth_gain == b->depth_gain && a->slip == b->slip);
}

} // namespace

HapticProperties steppedTowards(const HapticProperties& now, const HapticProperties& wanted) {
  HapticProperties next = wanted;
  next.stiffness = now.stiffness > 0
                       ? std::clamp(wanted.stiffness, now.stiffness / kStiffnessFactor,
                                    now.stiffness * kStiffnessFactor)
                       : wanted.stiffness;
  next.tip_radius = stepped(now.tip_radius, wanted.tip_radius, kRadiusStep);
  next.damping = stepped(now.damping, wanted.damping, kDampingStep);
  next.friction = stepped(now.friction, wanted.friction);
  return next;
}

bool same(const HapticProperties& a, const HapticProperties& b) {
  return a.stiffness == b.stiffness && a.damping == b.damping && a.tip_radius == b.tip_radius &&
         a.force_limit == b.force_limit && same(a.friction, b.friction);
}

} // namespace patina
