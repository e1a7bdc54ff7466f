#include "haptics/stability/local_stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/decompose.h"
#include "haptics/stages/coupling_stage.h"

namespace patina {
namespace {

constexpr double kForce = 1;         // [N]
constexpr double kStep = 0.25;       // voxels
constexpr double kMinGradient = 0.1; // K05
constexpr double kStart = 0.5;       // voxels outside, where the way in begins
// The contact point settles: in how many ticks, and to what step [voxels].
constexpr int kMostSettling = 32;
constexpr double kSettled = 1e-6;
constexpr double kSlips = 0.3; // of the depth, aside
// Ticks so far apart that no velocity is left over from the way in, and no ramp half done.
constexpr double kRest = 1e5; // [s]

Scene wallOf(const Scene& scene) {
  Scene wall = scene;
  wall.haptics.friction.reset();
  wall.haptics.damping.reset();
  wall.haptics.magnet.reset();
  wall.haptics.force_limit = std::numeric_limits<double>::infinity();
  return wall;
}

// A lateral coupling changes what the texture itself is; the rest is the loop's.
StabiliserPlan lateralOf(StabiliserPlan plan) {
  plan.coupling.reset();
  plan.passivity.reset();
  return plan;
}

} // namespace

StiffnessProbe::StiffnessProbe(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                               std::span<const FeltObject> objects)
    : wall_(compileStages(wallOf(scene), std::move(field), objects,
                          lateralOf(planOf(scene, objects)))),
      sampler_(*wall_->field, scene.sampler),
      reach_(scene.haptics.tip_radius.value_or(0) + scene.haptics.offset.value_or(0)),
      raised_(raisedBy(objects)), press_(std::min(kForce, scene.haptics.force_limit)),
      painted_(!objects.empty()) {
  if (const auto coupling = planOf(scene, objects).coupling) coupling_ = coupling->stiffness;
}

// Painted friction and damping are in the wall's stages, but a contact that begins has neither slid
// nor, with kRest, a velocity.
Contact StiffnessProbe::settled(ContactMemory& memory, const Vec3& tip) const {
  Contact contact = tick(*wall_, memory, tip, kRest);
  for (int i = 1; i < kMostSettling; ++i) {
    const Vec3 last = contact.candidate;
    contact = tick(*wall_, memory, tip, kRest);
    if ((contact.candidate - last).norm() < kSettled * sampler_.grid().voxel) break;
  }
  return contact;
}

Eigen::Matrix3d StiffnessProbe::differenced(const ContactMemory& at, const Vec3& tip,
                                            double step) const {
  const auto forceAt = [&](const Vec3& p) {
    ContactMemory memory = at;
    return settled(memory, p).force;
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
  Vec3 surface = point + (reach_ - sample.phi) * outward; // where the tip touches
  ContactMemory outside;
  const double voxel = sampler_.grid().voxel;
  tick(*wall_, outside, surface + (raised_ + kStart * voxel) * outward, kRest);
  // In a cleft the way in is not free: the tip is there without having come from anywhere.
  if (outside.contact.c) outside.reset();

  double stiffness = wall_->base.stiffness;
  if (painted_) { // what is felt there, and how high
    const Vec3 below = surface - (raised_ + press_ / stiffness) * outward;
    ContactMemory memory = outside;
    const Contact contact = settled(memory, below);
    if (contact.touching) stiffness = contact.material.stiffness;
    if (contact.touching && raised_ > 0)
      surface = below + contact.depth / std::sqrt(1 + contact.slope.squaredNorm()) * outward;
  }
  stiffness = inSeries(stiffness, coupling_);
  LocalStiffness result;
  result.depth = depth.value_or(press_ / stiffness);
  result.tip = surface - result.depth * outward;
  ContactMemory memory = outside;
  const Contact contact = settled(memory, result.tip);
  result.material = contact.material;
  result.lateral = contact.lateral;
  const Vec3 ran = contact.candidate - surface;
  result.slips = (ran - ran.dot(outward) * outward).norm() > kSlips * result.depth;
  const Vec3& force = contact.force;
  result.force = force.norm();
  if (!(result.force > 0)) return std::nullopt;
  result.normal = force / result.force;
  const double length = std::min(kStep * voxel, 0.5 * result.depth);
  result.matrix = differenced(memory, result.tip, length);
  const Eigen::Matrix3d change = differenced(memory, result.tip, 0.5 * length) - result.matrix;
  result.uncertainty = change.cwiseAbs().maxCoeff();
  // A texture is smooth, but as fine as the step: its differences are extrapolated to none. Not
  // those of facets, whose edges are no matter of the step's square.
  if (raised_ > 0) result.matrix += 4.0 / 3 * change;
  if (!result.matrix.allFinite()) return std::nullopt;
  const Vec3 values = SymmetricEigen(0.5 * (result.matrix + result.matrix.transpose())).values;
  result.lambda_min = values[0];
  result.lambda_max = values[2];
  return result;
}

} // namespace patina
