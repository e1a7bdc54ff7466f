#include "haptics/law/lateral_stage.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "haptics/contact/active_constraints.h"
#include "haptics/law/contact_memory.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/painted_range.h"

namespace patina {
namespace {

using Mat32 = Eigen::Matrix<double, 3, 2>;

constexpr int kMaxTries = 6;             // height evaluations per tick
constexpr double kForceTolerance = 1e-4; // tangential force below which the iteration ends [N]
constexpr double kBacktrack = 0.25;      // step factor after an increase of U
constexpr double kMinCurvature = 0.05;   // smallest curvature of a step, relative to k_l + B/T
constexpr double kOwnSpeed =
    0.1; // u moves without the tip if it is faster than the surface point by this [m/s]

} // namespace

struct LateralStage::Height {
  double h = 0; // [m]
  Vec3 slope = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero(); // [1/m]
};

LateralStage::LateralStage(std::shared_ptr<const Reliefs> reliefs,
                           std::span<const HapticObject> objects, double envelope,
                           const LateralPlan& plan)
    : reliefs_(std::move(reliefs)), objects_(objects), envelope_(envelope), plan_(plan) {
  for (const HapticObject& object : objects)
    stiff_.push_back(maxTextureCurvature(object) > plan.max_stable_curvature);
}

LateralStage::Height LateralStage::heightAt(const Contact& contact, const Vec3& lateral_offset,
                                            ReliefWalk& walk) const noexcept {
  Height height;
  const Vec3 at = contact.surface + lateral_offset;
  if (reliefs_) {
    const ReliefAt relief = reliefs_->at(contact.object, at, walk, &height.hessian);
    height.h = relief.height;
    height.slope = relief.slope();
  }
  const double roughness = contact.material.roughness;
  if (roughness > 0) {
    const Pose& object_from_world =
        objects_[static_cast<std::size_t>(contact.object)].object_from_world;
    const Eigen::Matrix3d turn = object_from_world.linear();
    Eigen::Matrix3d hessian;
    const RoughPattern pattern = roughPattern(object_from_world * at, &hessian);
    height.h += roughness * pattern.height;
    height.slope += roughness * (turn.transpose() * pattern.slope);
    height.hessian += roughness * (turn.transpose() * hessian * turn);
  }
  return height;
}

void LateralStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const auto object = static_cast<std::size_t>(contact.object);
  if (!contact.touching || contact.normal.isZero(0) || object >= stiff_.size() || !stiff_[object]) {
    memory.lateral.lateral_offset.setZero();
    return;
  }
  const double stiffness = inSeries(contact.material.stiffness, plan_.coupling);
  const double viscous = contact.dt > 0 ? plan_.damping / contact.dt : 0;
  const double own_curvature = plan_.stiffness + viscous; // curvature of spring and damper
  const double depth = contact.depth - envelope_;
  const Mat32 free = ActiveConstraints(contact).tangentBasis();
  const Vec2 before = free.transpose() * memory.lateral.lateral_offset;

  const auto heightOf = [&](const Vec2& u) { return heightAt(contact, free * u, memory.walk); };
  const auto energyOf = [&](const Vec2& u, const Height& at) {
    const double deep = std::max(depth + at.h, 0.0);
    return 0.5 * (plan_.stiffness * u.squaredNorm() + viscous * (u - before).squaredNorm() +
                  stiffness * deep * deep);
  };
  Vec2 u = before;
  Height at = heightOf(u);
  double energy = energyOf(u, at);
  for (int tries = 1; tries < kMaxTries;) {
    const double deep = std::max(depth + at.h, 0.0);
    const Vec2 slope = free.transpose() * at.slope;
    const Vec2 force = -plan_.stiffness * u - viscous * (u - before) - stiffness * deep * slope;
    // The first step is never skipped, even near equilibrium: without it the lateral spring would
    // not yield and the contact would feel stiff.
    if (tries > 1 && !(force.squaredNorm() > kForceTolerance * kForceTolerance)) break;
    if (force.isZero(0)) break;
    Eigen::Matrix2d curvature = own_curvature * Eigen::Matrix2d::Identity();
    if (deep > 0)
      curvature +=
          stiffness * (slope * slope.transpose() + deep * (free.transpose() * at.hessian * free));
    const double mean = 0.5 * curvature.trace();
    const double least =
        mean - std::hypot(0.5 * (curvature(0, 0) - curvature(1, 1)), curvature(0, 1));
    curvature += std::max(0.0, kMinCurvature * own_curvature - least) * Eigen::Matrix2d::Identity();
    Vec2 step = curvature.inverse() * force;
    bool went = false;
    while (!went && tries < kMaxTries) {
      const Vec2 aim = u + step;
      const Height there = heightOf(aim);
      ++tries;
      const double energy_there = energyOf(aim, there);
      went = energy_there <= energy;
      if (went) {
        u = aim;
        at = there;
        energy = energy_there;
      } else {
        step *= kBacktrack;
      }
    }
  }
  contact.lateral_offset = free * u;
  contact.lateral_stiffness = plan_.stiffness;
  const Vec3 drawn = contact.surface - memory.lateral.surface;
  const Vec2 ran = u - before;
  if (ran.norm() > drawn.norm() + kOwnSpeed * contact.dt) contact.snap = true;
  memory.lateral = {contact.lateral_offset, contact.surface};
}

} // namespace patina
