#include "haptics/law/stabilisers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/numbers.h"
#include "haptics/law/coupling_stage.h"

namespace patina {
namespace {

constexpr double kMargin = 2;                // K* over the stiffness
constexpr double kDampingFraction = 0.017;   // B T/m: far below the unstable damping
constexpr double kMinDecayRate = 12;         // smallest B/m, the decay rate of a touch [1/s]
constexpr double kDampingMargin = 5;         // unstable damping over B
constexpr double kPassivityNoise = 0.3;      // controller force per encoder step [N]
constexpr double kEncoderNoise = 0.03;       // largest force per encoder step [N]
constexpr double kMinCouplingFraction = 0.4; // fraction of the linear stability limit
constexpr double kMinLateral = 0.1;          // fraction of k_c, for a device without damping

std::string limitText(double limit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g N/m", limit);
  return text;
}

// Returns a text like "stiffness 1e+05 N/m, limit 1001 N/m".
std::string reasonFor(double stiffest, double limit, const std::optional<Stabilisers>& chosen) {
  const std::string facts = formatNumber(stiffest) + " N/m, limit " + limitText(limit);
  return chosen ? "chosen; stiffness " + facts : "stiffness " + facts;
}

} // namespace

double StabiliserPlan::seriesStiffness(double stiffness) const {
  return coupling ? inSeries(stiffness, coupling->stiffness) : stiffness;
}

SampledLoop sceneLoop(const HapticProperties& haptics, const DeviceModel& device,
                      const HandModel& hand) {
  SampledLoop loop = sampledLoop(device, hand);
  loop.virtual_damping = haptics.damping.value_or(0);
  if (haptics.damping) loop.cutoff = haptics.damping_cutoff;
  return loop;
}

CouplingPlan planCoupling(const HapticProperties& haptics, const DeviceModel& device) {
  SampledLoop loop = sampledLoop(device);
  const double too_much = dampingLimit(loop);
  double damping = loop.mass * std::max(kDampingFraction / loop.period, kMinDecayRate);
  damping = std::min(damping, too_much / kDampingMargin);
  if (device.encoder_step > 0)
    damping = std::min(damping, kEncoderNoise * loop.period / device.encoder_step);
  if (haptics.damping)
    damping = std::max(damping, std::min(*haptics.damping, too_much / kDampingMargin));
  loop.virtual_damping = damping;
  return {
      std::max(stiffnessLimit(loop) / kMargin, kMinCouplingFraction * linearStabilityLimit(loop)),
      damping, std::max(damping, too_much / kDampingMargin)};
}

LateralPlan planLateral(const HapticProperties& haptics, const DeviceModel& device) {
  const CouplingPlan normal = planCoupling(haptics, device);
  const double held = (0.5 + device.delay) / device.rate; // mean age of the applied force
  const double steady = std::sqrt(2 * device.damping * normal.damping) / held;
  return {std::clamp(steady, kMinLateral * normal.stiffness, normal.stiffness), normal.damping,
          maxStableCurvature(haptics.force_limit, device)};
}

double maxStableCurvature(double force_limit, const DeviceModel& device) {
  return stiffnessLimit(sampledLoop(device)) / (kMargin * force_limit);
}

StabiliserPlan planStabilisers(const HapticProperties& haptics,
                               const std::optional<DeviceModel>& device,
                               const std::optional<Stabilisers>& chosen,
                               std::optional<double> max_damping, double max_curvature) {
  StabiliserPlan plan;
  if (!device && !chosen) return plan;
  const DeviceModel model = device.value_or(DeviceModel{});
  plan.predicted_limit = stiffnessLimit(sceneLoop(haptics, model));
  if (max_damping && *max_damping > haptics.damping.value_or(0)) {
    HapticProperties damped = haptics;
    damped.damping = max_damping;
    plan.predicted_limit =
        std::min(*plan.predicted_limit, stiffnessLimit(sceneLoop(damped, model)));
  }
  const double stiffest =
      std::max(haptics.stiffness, haptics.magnet ? haptics.magnet->strength : 0.0);
  const bool safe = kMargin * stiffest <= *plan.predicted_limit;
  const Stabilisers wanted = chosen.value_or(Stabilisers{!safe, false});
  if ((!chosen || chosen->coupling) &&
      max_curvature > maxStableCurvature(haptics.force_limit, model)) {
    plan.lateral = planLateral(haptics, model);
    plan.lateral_why = "texture " + formatNumber(std::round(haptics.force_limit * max_curvature)) +
                       " N/m along the surface at " + formatNumber(haptics.force_limit) +
                       " N, limit " + limitText(stiffnessLimit(sampledLoop(model)));
  }
  if (!wanted.coupling && !wanted.passivity) return plan;

  plan.why = reasonFor(stiffest, *plan.predicted_limit, chosen);
  if (wanted.coupling) plan.coupling = planCoupling(haptics, model);
  if (plan.coupling && plan.lateral) plan.lateral->coupling = plan.coupling->stiffness;
  if (wanted.passivity) {
    PassivitySpec spec;
    spec.delay = model.delay;
    spec.max_damping = dampingLimit(sampledLoop(model)) / kMargin;
    if (model.encoder_step > 0)
      spec.max_damping =
          std::min(spec.max_damping, kPassivityNoise / (model.rate * model.encoder_step));
    if (haptics.magnet)
      spec.allowed_energy = 0.5 * plan.seriesStiffness(haptics.magnet->strength) *
                            haptics.magnet->range * haptics.magnet->range;
    plan.passivity = spec;
  }
  return plan;
}

} // namespace patina
