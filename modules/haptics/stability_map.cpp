#include "haptics/stability_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "haptics/coupling_stage.h"
#include "haptics/stabilisers.h"

namespace patina {
namespace {

// Of the wall's stiffness: a loop that bears less is as good as one without damping, and the
// differences' own rounding would decide between them.
constexpr double kNegligible = 1e-3;
constexpr std::size_t kBetweenPolls = 2000; // vertices, some 10 ms

// Largest lambda of wall u = lambda bearable u: how many times the loop's limit is exceeded.
double wallLoad(const LocalStiffness& at, const LoopLimits& limits) {
  const double least = kNegligible * at.matrix.cwiseAbs().maxCoeff();
  const double across = 1 / std::sqrt(std::max(limits.plain, least));
  const double along = 1 / std::sqrt(std::max(limits.damped, least));
  const Eigen::Matrix3d normal = at.normal * at.normal.transpose();
  const Eigen::Matrix3d scale = across * (Eigen::Matrix3d::Identity() - normal) + along * normal;
  const Eigen::Matrix3d load = scale * at.matrix * scale;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(load, Eigen::EigenvaluesOnly)
      .eigenvalues()[2];
}

} // namespace

LoopLimits loopLimits(const Scene& scene) {
  const HapticProperties& haptics = scene.haptics;
  const DeviceModel device = scene.device_model.value_or(DeviceModel{});
  SampledLoop loop = sceneLoop(haptics, device);
  LoopLimits limits;
  const auto plan = planStabilisers(haptics, scene.device_model, scene.stabilisers).coupling;
  if (plan) {
    loop.virtual_damping = plan->damping;
    loop.cutoff.reset();
    limits.softening = inSeries(haptics.stiffness, plan->stiffness) / haptics.stiffness;
    limits.coupled = true;
  }
  limits.damped = stiffnessLimit(loop);
  limits.plain = stiffnessLimit(sampledLoop(device));
  return limits;
}

double stabilityRatio(const LocalStiffness& at, const Scene& scene, const LoopLimits& limits) {
  const HapticProperties& haptics = scene.haptics;
  double load = limits.softening * wallLoad(at, limits);
  const double damped = std::max(limits.damped, kNegligible * haptics.stiffness);
  if (haptics.friction && haptics.friction->static_coefficient > 0)
    load = std::max(load, limits.softening * haptics.stiffness / damped);
  if (haptics.magnet && haptics.magnet->range > 0)
    load = std::max(load, haptics.magnet->strength / damped);
  return load > 0 ? 1 / load : std::numeric_limits<double>::infinity();
}

StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress) {
  const StiffnessProbe probe(scene, std::move(field));
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  StabilityMap map;
  map.limits = loopLimits(scene);
  map.ratio.assign(mesh.positions.size(), unknown);
  map.least.assign(mesh.positions.size(), unknown);
  map.worst_ratio = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (v % kBetweenPolls == 0) {
      progress.throwIfCancelled();
      progress.report(static_cast<double>(v) / static_cast<double>(mesh.positions.size()),
                      "stability");
    }
    const auto at = probe.at(mesh.positions[v]);
    if (!at) continue;
    const double ratio = stabilityRatio(*at, scene, map.limits);
    map.ratio[v] = static_cast<float>(ratio);
    map.least[v] = static_cast<float>(at->lambda_min);
    if (ratio < 1) ++map.buzzing;
    if (!(ratio >= map.worst_ratio)) {
      map.worst = v;
      map.worst_ratio = ratio;
      map.uncertainty = at->uncertainty / at->lambda_max;
    }
  }
  return map;
}

} // namespace patina
