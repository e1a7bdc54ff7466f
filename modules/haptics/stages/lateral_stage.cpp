#include "haptics/stages/lateral_stage.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "haptics/contact/contact_memory.h"
#include "haptics/contact/hold.h"
#include "haptics/stability/painted_range.h"
#include "haptics/stages/coupling_stage.h"

namespace patina {
namespace {

using Mat32 = Eigen::Matrix<double, 3, 2>;

constexpr int kMostTries = 6;       // looks at the height a tick
constexpr double kBalanced = 1e-4;  // [N] along the surface: left to the next tick
constexpr double kShorter = 0.25;   // of a step that led uphill
constexpr double kLeastBowl = 0.05; // of k_l + B/T: what a step takes the curvature for at least
constexpr double kOwnSpeed = 0.1;   // [m/s]: faster than it is drawn by this, u runs by itself

} // namespace

struct LateralStage::Height {
  double h = 0; // [m]
  Vec3 slope = Vec3::Zero();
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero(); // [1/m]
};

LateralStage::LateralStage(std::shared_ptr<const Reliefs> reliefs,
                           std::span<const FeltObject> objects, double shell,
                           const LateralPlan& plan)
    : reliefs_(std::move(reliefs)), objects_(objects), shell_(shell), plan_(plan) {
  for (const FeltObject& object : objects) stiff_.push_back(textureBend(object) > plan.steady_bend);
}

LateralStage::Height LateralStage::heightAt(const Contact& contact, const Vec3& aside,
                                            ReliefWalk& walk) const noexcept {
  Height height;
  const Vec3 at = contact.surface + aside;
  if (reliefs_) {
    const ReliefAt relief = reliefs_->at(contact.object, at, walk, &height.bend);
    height.h = relief.height;
    height.slope = relief.slope();
  }
  const double roughness = contact.material.roughness;
  if (roughness > 0) {
    const Pose& object_from_world =
        objects_[static_cast<std::size_t>(contact.object)].object_from_world;
    const Eigen::Matrix3d turn = object_from_world.linear();
    Eigen::Matrix3d bend;
    const RoughPattern pattern = roughPattern(object_from_world * at, &bend);
    height.h += roughness * pattern.height;
    height.slope += roughness * (turn.transpose() * pattern.slope);
    height.bend += roughness * (turn.transpose() * bend * turn);
  }
  return height;
}

void LateralStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const auto object = static_cast<std::size_t>(contact.object);
  if (!contact.touching || contact.normal.isZero(0) || object >= stiff_.size() || !stiff_[object]) {
    memory.lateral.aside.setZero();
    return;
  }
  const double stiffness = inSeries(contact.material.stiffness, plan_.coupling);
  const double viscous = contact.dt > 0 ? plan_.damping / contact.dt : 0;
  const double bowl = plan_.stiffness + viscous; // of spring and damper
  const double depth = contact.depth - shell_;
  const Mat32 free = WallHold(contact).free();
  const Vec2 before = free.transpose() * memory.lateral.aside;

  const auto heightOf = [&](const Vec2& u) { return heightAt(contact, free * u, memory.walk); };
  const auto energyOf = [&](const Vec2& u, const Height& at) {
    const double deep = std::max(depth + at.h, 0.0);
    return 0.5 * (plan_.stiffness * u.squaredNorm() + viscous * (u - before).squaredNorm() +
                  stiffness * deep * deep);
  };
  Vec2 u = before;
  Height at = heightOf(u);
  double energy = energyOf(u, at);
  for (int tries = 1; tries < kMostTries;) {
    const double deep = std::max(depth + at.h, 0.0);
    const Vec2 slope = free.transpose() * at.slope;
    const Vec2 force = -plan_.stiffness * u - viscous * (u - before) - stiffness * deep * slope;
    // A step from near balance costs no look, and where a tip rests it must not be left out: what
    // does not yield is stiff.
    if (tries > 1 && !(force.squaredNorm() > kBalanced * kBalanced)) break;
    if (force.isZero(0)) break;
    Eigen::Matrix2d curvature = bowl * Eigen::Matrix2d::Identity();
    if (deep > 0)
      curvature +=
          stiffness * (slope * slope.transpose() + deep * (free.transpose() * at.bend * free));
    const double mean = 0.5 * curvature.trace();
    const double least =
        mean - std::hypot(0.5 * (curvature(0, 0) - curvature(1, 1)), curvature(0, 1));
    curvature += std::max(0.0, kLeastBowl * bowl - least) * Eigen::Matrix2d::Identity();
    Vec2 step = curvature.inverse() * force;
    bool went = false;
    while (!went && tries < kMostTries) {
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
        step *= kShorter;
      }
    }
  }
  contact.aside = free * u;
  contact.lateral = plan_.stiffness;
  const Vec3 drawn = contact.surface - memory.lateral.surface;
  const Vec2 ran = u - before;
  if (ran.norm() > drawn.norm() + kOwnSpeed * contact.dt) contact.snap = true;
  memory.lateral = {contact.aside, contact.surface};
}

} // namespace patina
