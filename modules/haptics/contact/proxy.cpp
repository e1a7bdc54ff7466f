#include "haptics/contact/proxy.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

// Lengths in voxels, cosines, and slopes of phi, which is about 1.
constexpr double kOnSurface = 1e-5, kHeld = 1e-4;
constexpr double kAtRest = 3e-3;      // a step that is the last one
constexpr double kRestError = 3e-4;   // what a step may leave undone where the surface is smooth
constexpr double kTurnedError = 2e-3; // and before the turn of the surface is taken out of it
constexpr double kCreaseError = 5e-3; // the same where there may be several walls
constexpr double kLastError = 0.03;   // of the last look where the surface is smooth
constexpr double kCreaseStep = 0.03; // a step that is the last one where there may be several walls
constexpr double kMostRate = 0.8;    // of a step, that the next one takes
constexpr double kLeastRate = 0.06;  // below it a look at the wall as it was finds it as well
constexpr double kLeastWay = 1e-4;   // below it the turn of a normal is rounding
constexpr double kLongWay = 1e-2;    // from where on it tells how the wall will turn
constexpr double kMostStep = 0.1;
constexpr double kDeep = 0.35; // a look from deeper inside says nothing of the wall in front
constexpr double kFlat = 0.2, kLeastSlope = 0.3;
constexpr double kMostTrust = 2;
constexpr double kTrust = 1; // how far a wall is believed from where the VCP is feasible
constexpr double kSameWall = 0.97;
constexpr double kTurnOfAWall = 0.06; // squared, of normals with that cosine
constexpr double kRefuted = 0.02;
constexpr double kStale = 0.3; // an active wall seen farther away is looked at again
constexpr double kStaleTrust = 0.25;
constexpr double kForget = 2;
constexpr double kForgetLent = 100; // voxels of way, over which what moves gave is forgotten
constexpr double kLent = 4e-3;      // voxel^2, from where on it is taken back
constexpr double kRoom = 1 + 1e-6;  // of the square of a bound, for rounding
constexpr double kAlwaysSpread = 1e-12;
constexpr int kMostSlides = 3, kFewLooks = 3, kMostLooks = 8, kMostSecants = 4, kMostHalvings = 6;

} // namespace

struct ProxySearch::Seen {
  double height = 0; // phi - iso
  double slope = 0;
  Vec3 normal = Vec3::Zero();
  bool smooth = false; // no crease here
  bool known = false;  // in the band
  BandCell cell{};     // if known and curved_
};

// What the quick way has seen before it gave up.
struct ProxySearch::Tried {
  std::optional<Seen> first; // at the projection onto the wall, if there alone
  bool elsewhere = false;    // it has looked where c would be instead
  bool crease = false;
};

struct ProxySearch::Aim {
  WallProjection to;
  bool by_ball = false, by_trust = false;
};

ProxySearch::Seen ProxySearch::look(const Vec3& q, double own) const noexcept {
  if (sampler_->sampler() != Sampler::high) own = 0;
  // With relief baked in gradients are not of length 1, and a blend's length tells no crease.
  if (per_steepness_ < 1) own = std::max(own, kAlwaysSpread);
  Seen seen;
  const SurfaceSample sample = sampler_->surfaceAtGrid(q, own, curved_ ? &seen.cell : nullptr);
  seen.height = sample.phi - iso_;
  seen.known = sample.region == FieldRegion::band;
  seen.slope = sample.gradient.norm();
  if (seen.slope > 0) seen.normal = 1 / seen.slope * sample.gradient;
  seen.smooth = sample.spread == 0;
  return seen;
}

namespace {

// On a smooth surface blended normals are the more exact ones, but not those of the level set, so
// that a move of c may give work: the mean depth times how far it went along the mean normal, which
// is nothing on an exact surface. What it gave of late turns the normals to the level set's own:
// over faces gains and losses follow one another, and their sum would wander there by chance.
void lend(Proxy& proxy, double given, const Vec3& moved) noexcept {
  const double kept = std::max(0.0, 1 - moved.norm() / kForgetLent);
  proxy.lent = std::max(0.0, kept * proxy.lent + given);
}
double ownShare(const Proxy& proxy) noexcept {
  return std::clamp((proxy.lent - kLent) / kLent, 0.0, 1.0);
}

// A bounded move is the projection of a point nearer to the middle: cutting the way short instead
// would leave the walls. A few secants find the point; where they do not, halving does, between it
// and a point on the ball: a projection makes no distance longer, so that where the middle is
// itself free of the walls it stays within.
void shorten(const Walls& walls, const Vec3& middle, double radius, Vec3& target,
             WallProjection& to) noexcept {
  const double most = kRoom * radius * radius;
  const Vec3 whole = target - middle;
  double inside = std::min(1.0, radius / whole.norm()), outside = 1;
  const auto go = [&](double share) {
    target = middle + share * whole;
    to = projectOntoWalls(walls, target);
    return (to.z - middle).squaredNorm();
  };
  double squared = (to.z - middle).squaredNorm();
  for (int k = 0; k < kMostSecants && squared > most; ++k) {
    outside *= radius / std::sqrt(squared);
    squared = go(outside);
  }
  if (squared <= most) return;
  for (int k = 0; k < kMostHalvings; ++k) {
    const double share = 0.5 * (inside + outside);
    (go(share) > most ? outside : inside) = share;
  }
  go(inside);
}

// Drops or mends what a look at z refutes (P08). Of a convex obstacle a wall seen elsewhere claims
// too much; of a concave one it stays true.
void reviewWalls(Walls& walls, const Vec3& z, double height, const Vec3& normal,
                 bool smooth) noexcept {
  for (int i = walls.count - 1; i >= 0; --i) {
    WallPlane& wall = walls[i];
    const double excess = wall.height(z) - height;
    const bool same = wall.normal.dot(normal) > kSameWall;
    bool drop = false;
    if (excess < -kOnSurface) {
      drop = excess < -kRefuted || same;
      if (!drop) wall.offset += excess;
    } else if (same) {
      const double turn = (wall.normal - normal).norm();
      drop = smooth || turn < 1e-5 || excess < 0.2 * turn * (wall.seen - z).norm();
    }
    if (drop) walls.remove(i);
  }
}

// The active wall that was seen too far from z to be believed there, or -1.
int stalest(const Walls& walls, const WallProjection& held, const Vec3& z) noexcept {
  int stale = -1;
  for (int k = 0; k < held.count; ++k) {
    const int i = held.active[static_cast<std::size_t>(k)];
    if ((walls[i].seen - z).squaredNorm() > kStale * kStale) stale = i;
  }
  return stale;
}

} // namespace

WallPlane ProxySearch::wallAt(const Vec3& z, const Seen& seen) noexcept {
  return {seen.normal, seen.normal.dot(z) - seen.height / std::max(seen.slope, kLeastSlope), z};
}

ProxySearch::Aim ProxySearch::aimAt(const Vec3& x, const Walls& walls, const Vec3& start,
                                    double ball, const Vec3& anchor, double trust) const noexcept {
  Aim aim;
  Vec3 target = x;
  aim.to = projectOntoWalls(walls, target);
  const auto leaves = [&](const Vec3& middle, double radius) {
    return (aim.to.z - middle).squaredNorm() > radius * radius * kRoom;
  };
  aim.by_ball = leaves(start, ball);
  if (aim.by_ball) shorten(walls, start, ball, target, aim.to);
  aim.by_trust = leaves(anchor, trust);
  if (aim.by_trust) {
    shorten(walls, anchor, trust, target, aim.to);
    if (leaves(start, ball)) shorten(walls, start, ball, target, aim.to);
  }
  return aim;
}

// The usual tick: one wall, nearly where it was predicted. False: nothing was changed but `tried`.
//
// One look after another would find of each step the share of it by which the surface turns under
// the depth: a geometric series, whose sum is taken here along the way that was seen.
bool ProxySearch::slide(const Vec3& x, const Vec3& from, double ball, Proxy& proxy, ProxyMove& move,
                        Tried& tried) const noexcept {
  const WallPlane& before = proxy.walls[0];
  const Vec3& start = proxy.c;
  const double most = std::min(ball, kTrust), own = ownShare(proxy);
  const auto isNear = [&](const Vec3& p) { return (p - start).squaredNorm() < most * most; };
  WallPlane wall = before;
  double load = -wall.height(x);
  Vec3 c = x + load * wall.normal;
  // The wall is looked at where c will be if it turns on as the last tick saw it turn.
  if (const double rate = load * proxy.turn.per_voxel.dot(proxy.turn.along);
      std::abs(rate) > kLeastRate) {
    const double sum = 1 / (1 - std::min(rate, kMostRate));
    const Vec3 ahead = c + load * sum * (c - start).dot(proxy.turn.along) * proxy.turn.per_voxel;
    tried.elsewhere = isNear(ahead);
    if (tried.elsewhere) c = ahead;
  }
  WallTurn seen_turn = proxy.turn;
  bool& crease = tried.crease;
  for (int looks = 0; looks < kMostSlides; ++looks) {
    if (!(load > kOnSurface && isNear(c))) return false;
    const Vec3 z = c;
    const Seen seen = look(z, own);
    ++move.samples;
    crease = crease || !seen.smooth;
    tried.first.reset();
    if (looks == 0 && !tried.elsewhere) tried.first = seen;
    const Vec3 turn = seen.normal - wall.normal;
    const double turned = turn.squaredNorm();
    if (!seen.known || !(std::abs(seen.height) < kMostStep) || !(turned < kTurnOfAWall))
      return false;
    const Vec3 way = z - wall.seen;
    const double per_square = 1 / std::max(way.squaredNorm(), kLeastWay * kLeastWay),
                 curvature = per_square * turn.dot(way);
    if (looks == 0 && per_square * kLongWay * kLongWay < 1) {
      const double per_way = std::sqrt(per_square);
      seen_turn = {per_way * way, per_way * turn};
    }
    wall = wallAt(z, seen);
    WallPlane rest = wall; // seen at z: from a guessed normal facets would turn twice
    load = -wall.height(x);
    c = x + load * wall.normal;
    // Here, and not when a stage asks: while c is worked out there is time.
    if (curved_) move.jacobian.emplace(seen.cell, seen.normal, load, iso_);
    const Vec3 step = c - z;
    const double step_squared = step.squaredNorm();
    bool last = step_squared < kRestError * kRestError;
    if (!last) {
      const double share = load * load * turned * per_square,
                   sum = 1 / (1 - std::min(load * curvature, kMostRate)),
                   left = sum * sum * share * step_squared;
      const bool settles = share < 1;
      const double most_left = crease                    ? kCreaseError
                               : looks + 1 < kMostSlides ? kTurnedError
                                                         : kLastError;
      last = settles && step_squared < kMostStep * kMostStep && left < most_left * most_left;
      if (settles && left > kRestError * kRestError) {
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
    // Beside a crease another look may be another wall's, and no move of c makes it longer (P11).
    if (crease && !(load * load <= (start - x).squaredNorm())) return false;
    if (!(load > kOnSurface && (c - start).squaredNorm() < ball * ball)) return false;
    if (!crease)
      lend(proxy,
           0.25 * (before.normal.dot(start - from) + load) *
               (before.normal + rest.normal).dot(c - start),
           c - start);
    proxy.c = c;
    proxy.walls[0] = rest;
    proxy.turn = seen_turn;
    move.touching = move.smooth = true;
    move.held.load[0] = load;
    return true;
  }
  return false;
}

ProxyMove ProxySearch::follow(const Vec3& x, const Vec3& from, double ball,
                              Proxy& proxy) const noexcept {
  ProxyMove move;
  Tried tried;
  if (proxy.walls.count == 1 && slide(x, from, ball, proxy, move, tried)) return move;
  move.jacobian.reset();
  proxy.turn = {};
  Walls& walls = proxy.walls;
  Vec3 start = proxy.c, anchor = proxy.c;
  double anchor_height = 0, trust = kTrust;
  if (walls.count == 0) {
    const Seen seen = look(start);
    ++move.samples;
    anchor_height = std::max(seen.height, 0.0);
    if (seen.slope > kFlat) walls.add(wallAt(start, seen));
  }

  // Walls of blended normals meet nowhere on the surface: with several, each has the derivative.
  bool may_end = true, converged = false, smooth = false, crease = walls.count > 1 || tried.crease;
  Vec3 c = start;
  Seen seen;
  // One more for each voxel that c may have to go; what is left is the next tick's.
  const int most_looks = std::min(kFewLooks + static_cast<int>(std::min(ball, 9.0)), kMostLooks);
  Aim aim = aimAt(x, walls, start, ball, anchor, trust);
  for (int looks = 0; looks < most_looks && !converged; ++looks) {
    // Beyond every wall and near enough: contact has ended, unless there is another wall.
    if (may_end && aim.to.count == 0 && !aim.by_ball) {
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
      seen = look(z, crease ? 1.0 : ownShare(proxy));
      ++move.samples;
    }
    crease = crease || !seen.smooth;
    c = z;
    if (seen.height < -kDeep || (seen.slope < kFlat && seen.height < 0)) {
      const double share = std::clamp(anchor_height / (anchor_height - seen.height), 0.1, 0.5);
      aim.to.z = anchor + share * (z - anchor);
      trust = (aim.to.z - anchor).norm();
      if (trust < 1e-9) break;
      continue;
    }
    // Where walls meet on the surface itself another look could only take one of them away.
    if (std::abs(seen.height) < kHeld && aim.to.count > 1 && !aim.by_ball && !aim.by_trust &&
        stalest(walls, aim.to, z) < 0) {
      converged = true;
      break;
    }
    double turned = 0, since = 1;
    const bool lone = walls.count == 1;
    if (lone) {
      turned = (walls[0].normal - seen.normal).norm();
      since = (walls[0].seen - z).norm();
    }
    reviewWalls(walls, z, seen.height, seen.normal, !crease);
    if (seen.slope >= kFlat && seen.known) walls.add(wallAt(z, seen));
    if (seen.height >= -kOnSurface) {
      anchor = z;
      anchor_height = std::max(seen.height, 0.0);
      trust =
          std::max({std::min(kMostTrust, 2 * trust), kStaleTrust, per_steepness_ * seen.height});
    }
    const Aim next = aimAt(x, walls, start, ball, anchor, trust);
    const double step = (next.to.z - z).norm();
    const bool bounded = next.by_ball || next.by_trust;
    if (next.to.count == 0 && next.by_ball && !next.by_trust && seen.height >= 0 &&
        step < kAtRest) {
      converged = true; // on its way through free space
    } else if (!crease && walls.count == 1 && next.to.count == 1 && !bounded && step < kMostStep) {
      // What the step leaves undone is the share of it by which the surface turns under the depth.
      const double share = std::min(1.0, next.to.load[0] * turned / std::max(since, 1e-2));
      if (step < kRestError || (lone && share * step < kRestError)) {
        c = next.to.z;
        converged = smooth = true;
      }
    } else if ((crease || looks > 0) && !next.by_trust && next.to.count > 0 &&
               step < std::max(kCreaseStep, next.by_ball ? 0.3 * ball : 0) &&
               std::abs(seen.height) < kMostStep) {
      c = next.to.z;
      converged = true;
    } else if (std::abs(seen.height) < kHeld &&
               step < (next.by_ball ? std::max(kAtRest, 0.3 * ball) : kAtRest) && !next.by_trust) {
      const int stale = stalest(walls, next.to, z);
      if (stale < 0) {
        converged = true;
      } else {
        walls.remove(stale);
        aim = aimAt(x, walls, start, ball, anchor, trust);
        continue;
      }
    }
    aim = next;
  }

  if (!converged && seen.height < 0) {
    // Out to the surface; farther in than a step of Newton's tells, back to where c was feasible.
    c = seen.height > -kMostStep
            ? Vec3(c - seen.height / std::max(seen.slope, kLeastSlope) * seen.normal)
            : anchor;
  }
  if (!smooth) {
    const double from_start = (start - x).squaredNorm();
    if ((c - x).squaredNorm() > from_start)
      c = (anchor - x).squaredNorm() <= from_start ? anchor : start;
  } else if (const double d0 = (start - from).norm(), d1 = (c - x).norm();
             d0 > kOnSurface && d1 > kOnSurface) {
    lend(proxy, 0.25 * (d0 + d1) * (1 / d0 * (start - from) + 1 / d1 * (c - x)).dot(c - start),
         c - start);
  }
  for (int i = walls.count - 1; i >= 0; --i)
    if ((walls[i].seen - c).squaredNorm() > kForget * kForget) walls.remove(i);
  proxy.c = c;
  move.touching = true;
  move.snap = aim.by_ball;
  move.held = projectOntoWalls(walls, x);
  return move;
}

} // namespace patina
