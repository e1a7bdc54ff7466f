#include "haptics/stability/stability_map.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "core/decompose.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/painted_range.h"
#include "haptics/law/stabilisers.h"

namespace patina {
namespace {

constexpr double kForce = 1;         // [N]
constexpr double kStep = 0.25;       // voxels
constexpr double kMinGradient = 0.1; // K05
constexpr double kStart = 0.5;       // start of the approach outside the surface [voxels]
// Convergence of the contact point: largest number of ticks, and largest last step [voxels].
constexpr int kMaxConvergenceTicks = 32;
constexpr double kConverged = 1e-6;
constexpr double kMaxTangentialShift = 0.3; // tangential displacement per depth
// Quasi-static tick length, which leaves neither velocity nor unfinished ramps.
constexpr double kQuasiStaticStep = 1e5; // [s]

Scene wallOf(const Scene& scene) {
  Scene wall = scene;
  wall.haptics.friction.reset();
  wall.haptics.damping.reset();
  wall.haptics.magnet.reset();
  wall.haptics.force_limit = std::numeric_limits<double>::infinity();
  return wall;
}

// The lateral coupling changes the texture's stiffness; the other stabilisers belong to the loop.
StabiliserPlan lateralOf(StabiliserPlan plan) {
  plan.coupling.reset();
  plan.passivity.reset();
  return plan;
}

} // namespace

StiffnessProbe::StiffnessProbe(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                               std::span<const HapticObject> objects)
    : wall_(compileStages(wallOf(scene), std::move(field), objects,
                          lateralOf(planOf(scene, objects)))),
      sampler_(*wall_->field, scene.sampler),
      contact_offset_(scene.haptics.tip_radius.value_or(0) + scene.haptics.offset.value_or(0)),
      max_relief_(reliefOver(objects)), press_(std::min(kForce, scene.haptics.force_limit)),
      painted_(!objects.empty()) {
  if (const auto coupling = planOf(scene, objects).coupling) coupling_ = coupling->stiffness;
}

// Painted friction and damping have no effect, because a new contact has not slipped and
// kQuasiStaticStep leaves no velocity.
Contact StiffnessProbe::convergedContact(ContactMemory& memory, const Vec3& tip) const {
  Contact contact = tick(*wall_, memory, tip, kQuasiStaticStep);
  for (int i = 1; i < kMaxConvergenceTicks; ++i) {
    const Vec3 last = contact.frictionless_point;
    contact = tick(*wall_, memory, tip, kQuasiStaticStep);
    if ((contact.frictionless_point - last).norm() < kConverged * sampler_.grid().voxel) break;
  }
  return contact;
}

Eigen::Matrix3d StiffnessProbe::differenced(const ContactMemory& at, const Vec3& tip,
                                            double step) const {
  const auto forceAt = [&](const Vec3& p) {
    ContactMemory memory = at;
    return convergedContact(memory, p).force;
  };
  Eigen::Matrix3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 move = step * Vec3::Unit(axis);
    slope.col(axis) = (forceAt(tip - move) - forceAt(tip + move)) / (2 * step);
  }
  return slope;
}

std::optional<LocalStiffness> StiffnessProbe::at(const Vec3& point,
                                                 std::optional<double> depth) const {
  const GridSample sample = sampler_.at(point);
  const double slope = sample.gradient.norm();
  if (!(slope > kMinGradient)) return std::nullopt;
  const Vec3 outward = sample.gradient / slope;
  Vec3 surface = point + (contact_offset_ - sample.phi) * outward; // contact position of the tip
  ContactMemory outside;
  const double voxel = sampler_.grid().voxel;
  tick(*wall_, outside, surface + (max_relief_ + kStart * voxel) * outward, kQuasiStaticStep);
  // A cleft blocks the approach; the tip then starts without one.
  if (outside.contact.c) outside.reset();

  double stiffness = wall_->base.stiffness;
  if (painted_) { // material and height at the contact
    const Vec3 below = surface - (max_relief_ + press_ / stiffness) * outward;
    ContactMemory memory = outside;
    const Contact contact = convergedContact(memory, below);
    if (contact.touching) stiffness = contact.material.stiffness;
    if (contact.touching && max_relief_ > 0)
      surface = below + contact.depth / std::sqrt(1 + contact.slope.squaredNorm()) * outward;
  }
  stiffness = inSeries(stiffness, coupling_);
  LocalStiffness result;
  result.depth = depth.value_or(press_ / stiffness);
  result.tip = surface - result.depth * outward;
  ContactMemory memory = outside;
  const Contact contact = convergedContact(memory, result.tip);
  result.material = contact.material;
  result.lateral_stiffness = contact.lateral_stiffness;
  const Vec3 moved = contact.frictionless_point - surface;
  result.is_unstable =
      (moved - moved.dot(outward) * outward).norm() > kMaxTangentialShift * result.depth;
  const Vec3& force = contact.force;
  result.force = force.norm();
  if (!(result.force > 0)) return std::nullopt;
  result.normal = force / result.force;
  const double length = std::min(kStep * voxel, 0.5 * result.depth);
  result.matrix = differenced(memory, result.tip, length);
  const Eigen::Matrix3d change = differenced(memory, result.tip, 0.5 * length) - result.matrix;
  result.uncertainty = change.cwiseAbs().maxCoeff();
  // Extrapolates the differences of a texture, which is smooth but as fine as the step. Not those
  // of facets, whose error is not quadratic in the step.
  if (max_relief_ > 0) result.matrix += 4.0 / 3 * change;
  if (!result.matrix.allFinite()) return std::nullopt;
  const Vec3 values = SymmetricEigen(0.5 * (result.matrix + result.matrix.transpose())).values;
  result.lambda_min = values[0];
  result.lambda_max = values[2];
  return result;
}

namespace {

// Relative to the wall's stiffness: a smaller stable stiffness is within rounding.
constexpr double kNegligible = 1e-3;
// Change of the stiffness when the step is halved; it doubles across a discontinuity.
constexpr double kDiscontinuity = 0.25;
constexpr std::size_t kBetweenPolls = 2000; // vertices, about 10 ms

// Returns the ratio of an eigenvalue (in units of K*) to the stability limit. A real eigenvalue is
// its own ratio. A complex pair a +- ic also needs damping against whirl; its limit u solves (1 -
// u)^2 beta = u with beta = whirl (a / c)^2.
double utilisationOf(const std::complex<double>& eigenvalue, double whirl) {
  const double a = eigenvalue.real(), c = std::abs(eigenvalue.imag());
  if (!(a > 0) || c == 0) return a;
  const double beta = whirl * a * a / (c * c);
  if (beta > 1e9) return a;
  const double u = 2 * beta / (2 * beta + 1 + std::sqrt(4 * beta + 1));
  return a / u;
}

// Stable tangential stiffness. The coupling's damper moves by the share of the tip's motion that
// curvature or texture leaves to its spring, and damps by the square of that share.
double stableStiffnessAlong(const LocalStiffness& at, const StiffnessLimits& limits) {
  const double series_factor = limits.seriesFactor(at.material.stiffness);
  const double spring = at.lateral_stiffness > 0 ? at.lateral_stiffness
                        : limits.coupled()       ? series_factor * at.material.stiffness
                                                 : 0;
  if (!(spring > 0)) return limits.device_only;
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - at.normal * at.normal.transpose();
  const Eigen::Matrix3d along = flat * at.matrix * flat;
  const double stiffest =
      series_factor * SymmetricEigen(0.5 * (along + along.transpose())).values[2];
  const double share = std::clamp(stiffest / spring, 0.0, 1.0);
  return limits.device_only + (limits.coupled_normal - limits.device_only) * share * share;
}

// Largest ratio of demanded to stable stiffness over all directions.
double wallUtilisation(const LocalStiffness& at, const StiffnessLimits& limits) {
  const double least = kNegligible * at.matrix.cwiseAbs().maxCoeff();
  const double across = 1 / std::sqrt(std::max(stableStiffnessAlong(at, limits), least));
  const double along = 1 / std::sqrt(std::max(limits.damped, least));
  const Eigen::Matrix3d normal = at.normal * at.normal.transpose();
  const Eigen::Matrix3d scale = across * (Eigen::Matrix3d::Identity() - normal) + along * normal;
  double load = 0;
  for (const std::complex<double>& eigenvalue : eigenvaluesOf(scale * at.matrix * scale))
    load = std::max(load, utilisationOf(eigenvalue, limits.whirl));
  return load;
}

bool isUnstable(const LocalStiffness& at, const StiffnessLimits& limits) {
  return at.is_unstable ||
         limits.seriesFactor(at.material.stiffness) * at.lambda_min < -kMinHandStiffness;
}

bool isDiscontinuous(const LocalStiffness& at) {
  return at.uncertainty > kDiscontinuity * at.matrix.cwiseAbs().maxCoeff();
}

} // namespace

double StiffnessLimits::seriesFactor(double stiffness) const {
  return stiffness > 0 ? inSeries(stiffness, coupling) / stiffness : 1;
}

StiffnessLimits loopLimits(const Scene& scene, std::span<const HapticObject> objects) {
  const PaintedRange range = paintedRange(baseMaterial(scene.haptics), objects);
  HapticProperties haptics = worstCase(scene.haptics, range);
  const DeviceModel device = scene.device_model.value_or(DeviceModel{});
  StiffnessLimits limits;
  const StabiliserPlan stabilisers = planOf(scene, objects);
  const std::optional<CouplingPlan>& plan = stabilisers.coupling;
  const auto stableStiffness = [&](double damping) {
    SampledLoop loop = sceneLoop(haptics, device);
    loop.virtual_damping = damping;
    if (plan) loop.cutoff.reset();
    return stiffnessLimit(loop);
  };
  double least = haptics.damping.value_or(0), most = range.max.damping;
  if (plan) {
    limits.coupling = plan->stiffness;
    least = plan->damping;
    most = std::min(most, plan->max_damping);
  }
  limits.damped = stableStiffness(least);
  if (most > least) limits.damped = std::min(limits.damped, stableStiffness(most));
  limits.device_only = stiffnessLimit(sampledLoop(device));
  limits.coupled_normal = limits.device_only;
  if (plan || stabilisers.lateral) {
    SampledLoop loop = sampledLoop(device);
    loop.virtual_damping = plan ? plan->damping : stabilisers.lateral->damping;
    limits.coupled_normal = stiffnessLimit(loop);
  }
  if (limits.device_only > 0)
    limits.whirl = device.damping * device.damping / (device.mass * limits.device_only);
  return limits;
}

double stabilityRatio(const LocalStiffness& at, const Scene& scene, const StiffnessLimits& limits) {
  const double stiffness = at.material.stiffness;
  const double series_factor = limits.seriesFactor(stiffness);
  const double damped = std::max(limits.damped, kNegligible * stiffness);
  const double plane = stiffness / damped;
  double load = series_factor * (isUnstable(at, limits) ? plane : wallUtilisation(at, limits));
  // The wall excludes the scene's friction, but not painted friction.
  const bool sticks = (scene.haptics.friction && scene.haptics.friction->static_coefficient > 0) ||
                      std::max(at.material.static_friction, at.material.dynamic_friction) > 0;
  if (sticks) load = std::max(load, series_factor * plane);
  const std::optional<Magnet>& magnet = scene.haptics.magnet;
  if (magnet && magnet->range > 0)
    load = std::max(load, magnet->strength * limits.seriesFactor(magnet->strength) / damped);
  return load > 0 ? 1 / load : std::numeric_limits<double>::infinity();
}

StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress,
                          std::span<const HapticObject> objects) {
  StabilityMap map;
  map.limits = loopLimits(scene, objects);
  // The same force presses a softer surface deeper, and curvature effects grow with depth.
  const StiffnessProbe probe(scene, std::move(field), objects);
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  map.ratio.assign(mesh.positions.size(), unknown);
  map.least.assign(mesh.positions.size(), unknown);
  map.is_unstable.assign(mesh.positions.size(), false);
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
    if (isDiscontinuous(*at)) {
      ++map.discontinuous_count;
      continue;
    }
    const double ratio = stabilityRatio(*at, scene, map.limits);
    map.ratio[v] = static_cast<float>(ratio);
    if (ratio < 1) ++map.buzzing;
    map.is_unstable[v] = isUnstable(*at, map.limits);
    map.unstable_count += map.is_unstable[v] ? 1 : 0;
    if (!(ratio >= map.worst_ratio)) {
      map.worst = v;
      map.worst_ratio = ratio;
    }
  }
  return map;
}

} // namespace patina
