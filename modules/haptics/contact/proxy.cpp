#include "haptics/contact/proxy.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

// Lengths in voxels; cosines; slopes are |grad phi|, about 1.
constexpr double kOnSurface = 1e-5, kHeld = 1e-4;
constexpr double kFinalStep = 3e-3;         // a shorter step is the last one
constexpr double kResidualTolerance = 3e-4; // error left after a step on a smooth surface
constexpr double kTurnedError = 2e-3;       // the same before the correction by the normal rate
constexpr double kCreaseError = 5e-3;       // the same if there may be several walls
constexpr double kLastError = 0.03;         // the same at the last evaluation on a smooth surface
constexpr double kCreaseStep = 0.03;        // last step if there may be several walls
constexpr double kMaxRate = 0.8;            // largest ratio of successive steps
constexpr double kMinRate = 0.06;           // below it the evaluation needs no prediction
constexpr double kMinPath = 1e-4;           // below it the normal's change is rounding
constexpr double kMinRatePath = 1e-2;       // shortest path for a reliable normal rate
constexpr double kMaxStep = 0.1;
constexpr double kDeep = 0.35; // deeper evaluations say nothing about the wall in front
constexpr double kFlat = 0.2, kMinSlope = 0.3;
constexpr double kMaxValidityRadius = 2;
constexpr double kValidityRadius = 1; // validity radius of a wall around a feasible contact point
constexpr double kSameWall = 0.97;
constexpr double kMaxNormalChange = 0.06; // squared difference of normals with that cosine
constexpr double kViolated = 0.02;
constexpr double kRelinearize = 0.3; // an active wall linearised farther away is evaluated again
constexpr double kStaleValidity = 0.25;
constexpr double kDropDistance = 2;
constexpr double kEnergyMemory = 100; // path over which generated energy decays [voxel]
// generated energy above which the exact gradient is blended in [voxel^2]
constexpr double kMaxGeneratedEnergy = 4e-3;
constexpr double kRoundingMargin = 1 + 1e-6; // rounding margin of a squared bound
constexpr double kAlwaysSpread = 1e-12;
constexpr int kMaxSlides = 3, kMinEvaluations = 3, kMaxEvaluations = 8, kMaxSecants = 4,
              kMaxHalvings = 6;

} // namespace

struct ProxySearch::FieldEvaluation {
  double height = 0; // phi - iso
  double slope = 0;
  Vec3 normal = Vec3::Zero();
  bool smooth = false; // no crease here
  bool known = false;  // inside the band
  BandCell cell{};     // set if known and curved_
};

// Evaluations of the fast path before it gave up.
struct ProxySearch::FastPathResult {
  std::optional<FieldEvaluation> first; // at the projection onto the wall
  bool ahead = false;                   // evaluated ahead, at the predicted c
  bool crease = false;
};

struct ProxySearch::Target {
  WallProjection to;
  bool by_step = false, by_validity = false;
};

ProxySearch::FieldEvaluation ProxySearch::evaluate(const Vec3& q, double own) const noexcept {
  if (sampler_->sampler() != Sampler::high) own = 0;
  // Baked relief: gradients are not of unit length, and a blended one does not reveal a crease.
  if (per_lipschitz_ < 1) own = std::max(own, kAlwaysSpread);
  FieldEvaluation seen;
  const SurfaceSample sample = sampler_->surfaceAtGrid(q, own, curved_ ? &seen.cell : nullptr);
  seen.height = sample.phi - iso_;
  seen.known = sample.region == FieldRegion::band;
  seen.slope = sample.gradient.norm();
  if (seen.slope > 0) seen.normal = 1 / seen.slope * sample.gradient;
  seen.smooth = sample.normal_dispersion == 0;
  return seen;
}

namespace {

// Accumulates energy that a move of c generates: mean depth times move along the mean normal, zero
// on an exact surface. Blended normals are accurate, but not the gradient of one level set; if the
// energy exceeds a limit, correctionWeight() blends in the exact gradient. Not for facets, whose
// gains and losses alternate and would sum to a random walk.
void addGeneratedEnergy(Proxy& proxy, double given, const Vec3& moved) noexcept {
  const double kept = std::max(0.0, 1 - moved.norm() / kEnergyMemory);
  proxy.generated_energy = std::max(0.0, kept * proxy.generated_energy + given);
}
double correctionWeight(const Proxy& proxy) noexcept {
  return std::clamp((proxy.generated_energy - kMaxGeneratedEnergy) / kMaxGeneratedEnergy, 0.0, 1.0);
}

// Bounds a move by projecting a point closer to `middle`; cutting the path short would leave the
// walls. A few secant steps find the point, else bisection between it and a point on the sphere.
// The projection increases no distance, so a free `middle` gives a result within the radius.
void shorten(const Walls& walls, const Vec3& middle, double radius, Vec3& target,
             WallProjection& to) noexcept {
  const double most = kRoundingMargin * radius * radius;
  const Vec3 whole = target - middle;
  double inside = std::min(1.0, radius / whole.norm()), outside = 1;
  const auto go = [&](double share) {
    target = middle + share * whole;
    to = projectOntoWalls(walls, target);
    return (to.z - middle).squaredNorm();
  };
  double squared = (to.z - middle).squaredNorm();
  for (int k = 0; k < kMaxSecants && squared > most; ++k) {
    outside *= radius / std::sqrt(squared);
    squared = go(outside);
  }
  if (squared <= most) return;
  for (int k = 0; k < kMaxHalvings; ++k) {
    const double share = 0.5 * (inside + outside);
    (go(share) > most ? outside : inside) = share;
  }
  go(inside);
}

// Drops or corrects walls that an evaluation at z contradicts (P08). A wall linearised ahead is
// too strict on a convex obstacle and stays valid on a concave one.
void reviewWalls(Walls& walls, const Vec3& z, double height, const Vec3& normal,
                 bool smooth) noexcept {
  for (int i = walls.count - 1; i >= 0; --i) {
    WallPlane& wall = walls[i];
    const double excess = wall.height(z) - height;
    const bool same = wall.normal.dot(normal) > kSameWall;
    bool drop = false;
    if (excess < -kOnSurface) {
      drop = excess < -kViolated || same;
      if (!drop) wall.offset += excess;
    } else if (same) {
      const double turn = (wall.normal - normal).norm();
      drop = smooth || turn < 1e-5 || excess < 0.2 * turn * (wall.point - z).norm();
    }
    if (drop) walls.remove(i);
  }
}

// Returns an active wall that was linearised too far from z, or -1.
int mostStale(const Walls& walls, const WallProjection& held, const Vec3& z) noexcept {
  int stale = -1;
  for (int k = 0; k < held.count; ++k) {
    const int i = held.active[static_cast<std::size_t>(k)];
    if ((walls[i].point - z).squaredNorm() > kRelinearize * kRelinearize) stale = i;
  }
  return stale;
}

} // namespace

WallPlane ProxySearch::wallAt(const Vec3& z, const FieldEvaluation& seen) noexcept {
  return {seen.normal, seen.normal.dot(z) - seen.height / std::max(seen.slope, kMinSlope), z};
}

ProxySearch::Target ProxySearch::solveTarget(const Vec3& x, const Walls& walls, const Vec3& start,
                                             double step_radius, const Vec3& anchor,
                                             double validity_radius) const noexcept {
  Target aim;
  Vec3 target = x;
  aim.to = projectOntoWalls(walls, target);
  const auto leaves = [&](const Vec3& middle, double radius) {
    return (aim.to.z - middle).squaredNorm() > radius * radius * kRoundingMargin;
  };
  aim.by_step = leaves(start, step_radius);
  if (aim.by_step) shorten(walls, start, step_radius, target, aim.to);
  aim.by_validity = leaves(anchor, validity_radius);
  if (aim.by_validity) {
    shorten(walls, anchor, validity_radius, target, aim.to);
    if (leaves(start, step_radius)) shorten(walls, start, step_radius, target, aim.to);
  }
  return aim;
}

// Fast path of a usual tick: one wall, close to its prediction. Returns false with only `tried`
// changed. Each evaluation would shrink the step by the normal's change times the depth, a
// geometric series; its sum is extrapolated along the measured path.
bool ProxySearch::slide(const Vec3& x, const Vec3& from, double step_radius, Proxy& proxy,
                        ProxyMove& move, FastPathResult& tried) const noexcept {
  const WallPlane& before = proxy.walls[0];
  const Vec3& start = proxy.c;
  const double most = std::min(step_radius, kValidityRadius), own = correctionWeight(proxy);
  const auto isNear = [&](const Vec3& p) { return (p - start).squaredNorm() < most * most; };
  WallPlane wall = before;
  double load = -wall.height(x);
  Vec3 c = x + load * wall.normal;
  // Evaluates the wall at the predicted c, assuming the normal rate of the last tick.
  if (const double rate = load * proxy.normal_rate.per_voxel.dot(proxy.normal_rate.along);
      std::abs(rate) > kMinRate) {
    const double sum = 1 / (1 - std::min(rate, kMaxRate));
    const Vec3 ahead =
        c + load * sum * (c - start).dot(proxy.normal_rate.along) * proxy.normal_rate.per_voxel;
    tried.ahead = isNear(ahead);
    if (tried.ahead) c = ahead;
  }
  NormalRate measured_rate = proxy.normal_rate;
  bool& crease = tried.crease;
  for (int evaluations = 0; evaluations < kMaxSlides; ++evaluations) {
    if (!(load > kOnSurface && isNear(c))) return false;
    const Vec3 z = c;
    const FieldEvaluation seen = evaluate(z, own);
    ++move.samples;
    crease = crease || !seen.smooth;
    tried.first.reset();
    if (evaluations == 0 && !tried.ahead) tried.first = seen;
    const Vec3 turn = seen.normal - wall.normal;
    const double turned = turn.squaredNorm();
    if (!seen.known || !(std::abs(seen.height) < kMaxStep) || !(turned < kMaxNormalChange))
      return false;
    const Vec3 way = z - wall.point;
    const double per_square = 1 / std::max(way.squaredNorm(), kMinPath * kMinPath),
                 curvature = per_square * turn.dot(way);
    if (evaluations == 0 && per_square * kMinRatePath * kMinRatePath < 1) {
      const double per_way = std::sqrt(per_square);
      measured_rate = {per_way * way, per_way * turn};
    }
    wall = wallAt(z, seen);
    WallPlane rest =
        wall; // linearised at z: a predicted normal would count the facets' rotation twice
    load = -wall.height(x);
    c = x + load * wall.normal;
    // Computed here, where its latency is hidden, and not on a stage's request.
    if (curved_) move.jacobian.emplace(seen.cell, seen.normal, load, iso_);
    const Vec3 step = c - z;
    const double step_squared = step.squaredNorm();
    bool last = step_squared < kResidualTolerance * kResidualTolerance;
    if (!last) {
      const double share = load * load * turned * per_square,
                   sum = 1 / (1 - std::min(load * curvature, kMaxRate)),
                   left = sum * sum * share * step_squared;
      const bool settles = share < 1;
      const double most_left = crease                         ? kCreaseError
                               : evaluations + 1 < kMaxSlides ? kTurnedError
                                                              : kLastError;
      last = settles && step_squared < kMaxStep * kMaxStep && left < most_left * most_left;
      if (settles && left > kResidualTolerance * kResidualTolerance) {
        WallPlane guess = wall;
        guess.normal = (wall.normal + sum * step.dot(way) * per_square * turn).normalized();
        guess.offset = guess.normal.dot(c);
        const double guessed_load = -guess.height(x);
        const Vec3 guessed = x + guessed_load * guess.normal;
        if (isNear(guessed)) {
          rest = guess;
          load = guessed_load;
          c = guessed;
        } else {
          last = false;
        }
      }
    }
    if (!last) continue;
    // Next to a crease another wall may be met, and |c - x| may not increase (P11).
    if (crease && !(load * load <= (start - x).squaredNorm())) return false;
    if (!(load > kOnSurface && (c - start).squaredNorm() < step_radius * step_radius)) return false;
    if (!crease)
      addGeneratedEnergy(proxy,
                         0.25 * (before.normal.dot(start - from) + load) *
                             (before.normal + rest.normal).dot(c - start),
                         c - start);
    proxy.c = c;
    proxy.walls[0] = rest;
    proxy.normal_rate = measured_rate;
    move.touching = move.smooth = true;
    move.held.multiplier[0] = load;
    return true;
  }
  return false;
}

ProxyMove ProxySearch::follow(const Vec3& x, const Vec3& from, double step_radius,
                              Proxy& proxy) const noexcept {
  ProxyMove move;
  FastPathResult tried;
  if (proxy.walls.count == 1 && slide(x, from, step_radius, proxy, move, tried)) return move;
  move.jacobian.reset();
  proxy.normal_rate = {};
  Walls& walls = proxy.walls;
  Vec3 start = proxy.c, anchor = proxy.c;
  double anchor_height = 0, validity_radius = kValidityRadius;
  if (walls.count == 0) {
    const FieldEvaluation seen = evaluate(start);
    ++move.samples;
    anchor_height = std::max(seen.height, 0.0);
    if (seen.slope > kFlat) walls.add(wallAt(start, seen));
  }

  // Blended normals of several walls do not meet on the surface, so they use exact gradients.
  bool may_end = true, converged = false, smooth = false, crease = walls.count > 1 || tried.crease;
  Vec3 c = start;
  FieldEvaluation seen;
  // One more evaluation for each voxel that c may have to move; the next tick continues.
  const int max_evaluations =
      std::min(kMinEvaluations + static_cast<int>(std::min(step_radius, 9.0)), kMaxEvaluations);
  Target aim = solveTarget(x, walls, start, step_radius, anchor, validity_radius);
  for (int evaluations = 0; evaluations < max_evaluations && !converged; ++evaluations) {
    // The tip is outside every known wall and within the step radius: contact has ended unless
    // another wall stands between.
    if (may_end && aim.to.count == 0 && !aim.by_step) {
      const double at_x = heightAt(x);
      ++move.samples;
      if (at_x >= 0 && isFree(anchor, anchor_height, x, at_x, move.samples)) {
        move.clearance = at_x;
        return move;
      }
      may_end = false;
    }
    const Vec3 z = aim.to.z;
    if (tried.first) {
      seen = *tried.first;
      tried.first.reset();
    } else {
      seen = evaluate(z, crease ? 1.0 : correctionWeight(proxy));
      ++move.samples;
    }
    crease = crease || !seen.smooth;
    c = z;
    if (seen.height < -kDeep || (seen.slope < kFlat && seen.height < 0)) {
      const double share = std::clamp(anchor_height / (anchor_height - seen.height), 0.1, 0.5);
      aim.to.z = anchor + share * (z - anchor);
      validity_radius = (aim.to.z - anchor).norm();
      if (validity_radius < 1e-9) break;
      continue;
    }
    // If walls meet on the surface itself, another evaluation could only remove one.
    if (std::abs(seen.height) < kHeld && aim.to.count > 1 && !aim.by_step && !aim.by_validity &&
        mostStale(walls, aim.to, z) < 0) {
      converged = true;
      break;
    }
    double turned = 0, since = 1;
    const bool lone = walls.count == 1;
    if (lone) {
      turned = (walls[0].normal - seen.normal).norm();
      since = (walls[0].point - z).norm();
    }
    reviewWalls(walls, z, seen.height, seen.normal, !crease);
    if (seen.slope >= kFlat && seen.known) walls.add(wallAt(z, seen));
    if (seen.height >= -kOnSurface) {
      anchor = z;
      anchor_height = std::max(seen.height, 0.0);
      validity_radius = std::max({std::min(kMaxValidityRadius, 2 * validity_radius), kStaleValidity,
                                  per_lipschitz_ * seen.height});
    }
    const Target next = solveTarget(x, walls, start, step_radius, anchor, validity_radius);
    const double step = (next.to.z - z).norm();
    const bool bounded = next.by_step || next.by_validity;
    if (next.to.count == 0 && next.by_step && !next.by_validity && seen.height >= 0 &&
        step < kFinalStep) {
      converged = true; // moves through free space
    } else if (!crease && walls.count == 1 && next.to.count == 1 && !bounded && step < kMaxStep) {
      // The error of the step is its length times the normal's change times the depth.
      const double share = std::min(1.0, next.to.multiplier[0] * turned / std::max(since, 1e-2));
      if (step < kResidualTolerance || (lone && share * step < kResidualTolerance)) {
        c = next.to.z;
        converged = smooth = true;
      }
    } else if ((crease || evaluations > 0) && !next.by_validity && next.to.count > 0 &&
               step < std::max(kCreaseStep, next.by_step ? 0.3 * step_radius : 0) &&
               std::abs(seen.height) < kMaxStep) {
      c = next.to.z;
      converged = true;
    } else if (std::abs(seen.height) < kHeld &&
               step < (next.by_step ? std::max(kFinalStep, 0.3 * step_radius) : kFinalStep) &&
               !next.by_validity) {
      const int stale = mostStale(walls, next.to, z);
      if (stale < 0) {
        converged = true;
      } else {
        walls.remove(stale);
        aim = solveTarget(x, walls, start, step_radius, anchor, validity_radius);
        continue;
      }
    }
    aim = next;
  }

  if (!converged && seen.height < 0) {
    // Corrects c by a Newton step or, if too deep, returns to the feasible point.
    c = seen.height > -kMaxStep
            ? Vec3(c - seen.height / std::max(seen.slope, kMinSlope) * seen.normal)
            : anchor;
  }
  if (!smooth) {
    const double from_start = (start - x).squaredNorm();
    if ((c - x).squaredNorm() > from_start)
      c = (anchor - x).squaredNorm() <= from_start ? anchor : start;
  } else if (const double d0 = (start - from).norm(), d1 = (c - x).norm();
             d0 > kOnSurface && d1 > kOnSurface) {
    addGeneratedEnergy(
        proxy, 0.25 * (d0 + d1) * (1 / d0 * (start - from) + 1 / d1 * (c - x)).dot(c - start),
        c - start);
  }
  for (int i = walls.count - 1; i >= 0; --i)
    if ((walls[i].point - c).squaredNorm() > kDropDistance * kDropDistance) walls.remove(i);
  proxy.c = c;
  move.touching = true;
  move.snap = aim.by_step;
  move.held = projectOntoWalls(walls, x);
  return move;
}

} // namespace patina
