#include "haptics/stability/stability_map.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "core/decompose.h"
#include "haptics/stability/painted_range.h"
#include "haptics/stability/stabilisers.h"
#include "haptics/stages/coupling_stage.h"

namespace patina {
namespace {

// Of the wall's stiffness: a loop that bears less is as good as one without damping, and the
// differences' own rounding would decide between them.
constexpr double kNegligible = 1e-3;
// Of the stiffness, when the step is halved; across a jump it doubles.
constexpr double kJump = 0.25;
constexpr std::size_t kBetweenPolls = 2000; // vertices, some 10 ms

// How many times the limit of the loop an eigenvalue is, given as a multiple of K*. A real one has
// nothing more to say. A pair a +- ic needs damping to hold the whirl down as well as the sampling:
// stable up to u of K* with (1 - u)^2 beta = u, beta = whirl (a / c)^2.
double loadOf(const std::complex<double>& eigenvalue, double whirl) {
  const double a = eigenvalue.real(), c = std::abs(eigenvalue.imag());
  if (!(a > 0) || c == 0) return a;
  const double beta = whirl * a * a / (c * c);
  if (beta > 1e9) return a;
  const double u = 2 * beta / (2 * beta + 1 + std::sqrt(4 * beta + 1));
  return a / u;
}

// What the loop bears along the surface. The damper of a coupling moves by the share of the tip's
// motion that the surface's curvature or texture leaves to its spring, and so damps by that share's
// square.
double borneAlong(const LocalStiffness& at, const LoopLimits& limits) {
  const double softening = limits.softening(at.material.stiffness);
  const double spring = at.lateral > 0     ? at.lateral
                        : limits.coupled() ? softening * at.material.stiffness
                                           : 0;
  if (!(spring > 0)) return limits.plain;
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - at.normal * at.normal.transpose();
  const Eigen::Matrix3d along = flat * at.matrix * flat;
  const double stiffest = softening * SymmetricEigen(0.5 * (along + along.transpose())).values[2];
  const double share = std::clamp(stiffest / spring, 0.0, 1.0);
  return limits.plain + (limits.tied - limits.plain) * share * share;
}

// How many times over the wall asks for what the loop bears, in the worst direction.
double wallLoad(const LocalStiffness& at, const LoopLimits& limits) {
  const double least = kNegligible * at.matrix.cwiseAbs().maxCoeff();
  const double across = 1 / std::sqrt(std::max(borneAlong(at, limits), least));
  const double along = 1 / std::sqrt(std::max(limits.damped, least));
  const Eigen::Matrix3d normal = at.normal * at.normal.transpose();
  const Eigen::Matrix3d scale = across * (Eigen::Matrix3d::Identity() - normal) + along * normal;
  double load = 0;
  for (const std::complex<double>& eigenvalue : eigenvaluesOf(scale * at.matrix * scale))
    load = std::max(load, loadOf(eigenvalue, limits.whirl));
  return load;
}

bool slips(const LocalStiffness& at, const LoopLimits& limits) {
  return at.slips || limits.softening(at.material.stiffness) * at.lambda_min < -kGrip;
}

bool jumps(const LocalStiffness& at) {
  return at.uncertainty > kJump * at.matrix.cwiseAbs().maxCoeff();
}

} // namespace

double LoopLimits::softening(double stiffness) const {
  return stiffness > 0 ? inSeries(stiffness, coupling) / stiffness : 1;
}

LoopLimits loopLimits(const Scene& scene, std::span<const FeltObject> objects) {
  const PaintedRange range = paintedRange(baseMaterial(scene.haptics), objects);
  HapticProperties haptics = hardest(scene.haptics, range);
  const DeviceModel device = scene.device_model.value_or(DeviceModel{});
  LoopLimits limits;
  const StabiliserPlan stabilisers = planOf(scene, objects);
  const std::optional<CouplingPlan>& plan = stabilisers.coupling;
  const auto borne = [&](double damping) {
    SampledLoop loop = sceneLoop(haptics, device);
    loop.virtual_damping = damping;
    if (plan) loop.cutoff.reset();
    return stiffnessLimit(loop);
  };
  double least = haptics.damping.value_or(0), most = range.most.damping;
  if (plan) {
    limits.coupling = plan->stiffness;
    least = plan->damping;
    most = std::min(most, plan->most_damping);
  }
  limits.damped = borne(least);
  if (most > least) limits.damped = std::min(limits.damped, borne(most));
  limits.plain = stiffnessLimit(sampledLoop(device));
  limits.tied = limits.plain;
  if (plan || stabilisers.lateral) {
    SampledLoop loop = sampledLoop(device);
    loop.virtual_damping = plan ? plan->damping : stabilisers.lateral->damping;
    limits.tied = stiffnessLimit(loop);
  }
  if (limits.plain > 0)
    limits.whirl = device.damping * device.damping / (device.mass * limits.plain);
  return limits;
}

double stabilityRatio(const LocalStiffness& at, const Scene& scene, const LoopLimits& limits) {
  const double stiffness = at.material.stiffness;
  const double softening = limits.softening(stiffness);
  const double damped = std::max(limits.damped, kNegligible * stiffness);
  const double plane = stiffness / damped;
  double load = softening * (slips(at, limits) ? plane : wallLoad(at, limits));
  // The wall itself has none of the scene's friction, but what is painted.
  const bool sticks = (scene.haptics.friction && scene.haptics.friction->static_coefficient > 0) ||
                      std::max(at.material.static_friction, at.material.dynamic_friction) > 0;
  if (sticks) load = std::max(load, softening * plane);
  const std::optional<Magnet>& magnet = scene.haptics.magnet;
  if (magnet && magnet->range > 0)
    load = std::max(load, magnet->strength * limits.softening(magnet->strength) / damped);
  return load > 0 ? 1 / load : std::numeric_limits<double>::infinity();
}

StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress,
                          std::span<const FeltObject> objects) {
  StabilityMap map;
  map.limits = loopLimits(scene, objects);
  // A softer surface is pressed deeper by the same force, and what bends counts by depth.
  const StiffnessProbe probe(scene, std::move(field), objects);
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  map.ratio.assign(mesh.positions.size(), unknown);
  map.least.assign(mesh.positions.size(), unknown);
  map.slips.assign(mesh.positions.size(), false);
  map.worst_ratio = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (v % kBetweenPolls == 0) {
      progress.throwIfCancelled();
      progress.report(static_cast<double>(v) / static_cast<double>(mesh.positions.size()),
                      "stability");
    }
    const auto at = probe.at(mesh.positions[v]);
    if (!at) continue;
    map.least[v] = static_cast<float>(at->lambda_min);
    if (jumps(*at)) {
      ++map.jumping;
      continue;
    }
    const double ratio = stabilityRatio(*at, scene, map.limits);
    map.ratio[v] = static_cast<float>(ratio);
    if (ratio < 1) ++map.buzzing;
    map.slips[v] = slips(*at, map.limits);
    map.slipping += map.slips[v] ? 1 : 0;
    if (!(ratio >= map.worst_ratio)) {
      map.worst = v;
      map.worst_ratio = ratio;
    }
  }
  return map;
}

} // namespace patina
