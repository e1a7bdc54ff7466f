#include "acquisition/tracking/rig_pose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/tracking/face_likeness.h"
#include "core/decompose.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kFar = 10;   // by how much a marker may miss a first guess [px]
constexpr double kMisfit = 2; // rms that no good rig leaves [px]
constexpr double kPrior = 8;  // for how many residuals the edges' own deviations count
constexpr double kDoubt = 12; // squared residuals by which another pose must be worse
// Beyond the first nobody asks how the faces look; what is systematic about edges counts as the
// other.
constexpr double kNoDoubt = 150, kMostTrust = 24;
constexpr double kContradicts = 6; // times the spread without it that a wrong marker makes
constexpr double kSame = 0.05;     // poses nearer to one another are one [rad]
constexpr double kOwnTurn = 0.3;   // the most that a hand turns from frame to frame [rad]

// A seen marker and where the rig has it.
struct Sight {
  const SeenMarker* seen;
  std::array<Vec3, 4> corner; // in the probe's frame
  const RigMarker* marker;
};

Vec2 pinhole(const Camera& camera, const Vec3& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

// Mean square of the corners' misses [px^2].
double missOf(const Sight& sight, const Camera& camera, const Pose& pose) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = pose * sight.corner[i];
    if (!(p.z() > 1e-6)) return 1e12;
    sum += (pinhole(camera, p) - sight.seen->corner[i].straight).squaredNorm() / 4;
  }
  return sum;
}

struct Fit {
  Pose pose;
  double cost = 0; // sum of squared residuals, each over its deviation
  Mat6 normal = Mat6::Zero();
};

// Residuals of all corners, and what turns and shifts in the camera's frame do to them.
Fit linearised(const std::vector<Sight>& sights, const Camera& camera, const Pose& pose,
               Vec6& gradient) {
  Fit fit{pose};
  gradient.setZero();
  for (const Sight& sight : sights)
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 arm = pose.linear() * sight.corner[i], p = arm + pose.translation();
      if (!(p.z() > 1e-6)) {
        fit.cost = INFINITY;
        return fit;
      }
      const FittedCorner& corner = sight.seen->corner[i];
      const Vec2 e = corner.whiten * (pinhole(camera, p) - corner.straight);
      Eigen::Matrix<double, 2, 3> in;
      in << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0, camera.fy / p.z(),
          -camera.fy * p.y() / (p.z() * p.z());
      Eigen::Matrix3d turn;
      turn << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
      Eigen::Matrix<double, 2, 6> J;
      J << corner.whiten * in, corner.whiten * in * turn;
      fit.cost += e.squaredNorm();
      fit.normal += J.transpose() * J;
      gradient += J.transpose() * e;
    }
  return fit;
}

Pose moved(const Pose& pose, const Vec6& step) {
  Pose out = pose;
  const Vec3 turn = step.tail<3>();
  const double angle = turn.norm();
  if (angle > 0) out.linear() = Eigen::AngleAxisd(angle, turn / angle) * pose.linear();
  out.translation() += step.head<3>();
  return out;
}

// Levenberg and Marquardt.
Fit refined(const std::vector<Sight>& sights, const Camera& camera, const Pose& start) {
  Vec6 gradient, next_gradient;
  Fit fit = linearised(sights, camera, start, gradient);
  double damping = 1e-4;
  for (int i = 0; i < 40 && damping < 1e8; ++i) {
    Mat6 damped = fit.normal;
    damped.diagonal() *= 1 + damping;
    const Vec6 step = -SymmetricSolver(damped).solve(gradient);
    const Fit next = linearised(sights, camera, moved(fit.pose, step), next_gradient);
    if (!(next.cost < fit.cost)) {
      damping *= 10;
      continue;
    }
    const bool done = fit.cost - next.cost < 1e-10 * fit.cost;
    fit = next;
    gradient = next_gradient;
    damping = std::max(damping / 10, 1e-10);
    if (done) break;
  }
  return fit;
}

// Of one marker from its homography; a picture of a flat thing has a second pose that nearly fits,
// the normal mirrored at the line of sight.
std::array<Pose, 2> guesses(const Sight& sight, const Camera& camera) {
  Quad flat;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2& p = sight.seen->corner[i].straight;
    flat[i] = {(p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy};
  }
  const Eigen::Matrix3d map = squareTo(flat);
  const double size = sight.marker->size;
  const Vec3 x = map.col(0) / size, y = -map.col(1) / size;
  const double scale = 2 / (x.norm() + y.norm());
  const Vec3 sum = (x.normalized() + y.normalized()).normalized(),
             difference = (x.normalized() - y.normalized()).normalized();
  Pose one = Pose::Identity();
  one.linear().col(0) = (sum + difference).normalized();
  one.linear().col(1) = (sum - difference).normalized();
  one.linear().col(2) = one.linear().col(0).cross(one.linear().col(1));
  one.translation() = scale * map * Vec3(0.5, 0.5, 1);
  const Vec3 sight_line = one.translation().normalized(), normal = one.linear().col(2);
  const Vec3 mirrored = 2 * sight_line.dot(normal) * sight_line - normal;
  Pose other = one;
  other.linear() = turnFromTo(normal, mirrored).toRotationMatrix() * one.linear();
  const Pose marker_from_probe = sight.marker->probe_from_marker.inverse();
  return {one * marker_from_probe, other * marker_from_probe};
}

double angleBetween(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

Vec2 centreOf(const SeenMarker& marker) {
  Vec2 sum = Vec2::Zero();
  for (const FittedCorner& corner : marker.corner) sum += corner.pixel;
  return sum / 4;
}

// A marker that is seen more than once is seen wrongly at least once: none of its images counts.
std::vector<Sight> sightsOf(const std::vector<SeenMarker>& seen, const std::vector<RigMarker>& rig,
                            std::vector<RepeatedMarker>& repeated) {
  std::vector<Sight> sights;
  for (const RigMarker& marker : rig) {
    const auto is = [&](const SeenMarker& s) {
      return s.id == marker.id && s.family == marker.family;
    };
    std::vector<const SeenMarker*> images;
    for (const SeenMarker& image : seen)
      if (is(image)) images.push_back(&image);
    if (images.size() == 1) sights.push_back({images[0], marker.corners(), &marker});
    if (images.size() < 2) continue;
    repeated.push_back({marker.family, marker.id, {}});
    for (const SeenMarker* image : images) repeated.back().places.push_back(centreOf(*image));
  }
  return sights;
}

// A corner counts as exactly as it is known: those of a face seen from its edge hardly.
double rmsOf(const std::vector<Sight>& sights, const Camera& camera, const Pose& pose) {
  double sum = 0, weights = 0;
  for (const Sight& sight : sights)
    for (std::size_t i = 0; i < 4; ++i) {
      const FittedCorner& corner = sight.seen->corner[i];
      const Vec2 miss = pinhole(camera, pose * sight.corner[i]) - corner.straight;
      sum += 2 * (corner.whiten * miss).squaredNorm();
      weights += corner.whiten.squaredNorm();
    }
  return std::sqrt(sum / weights);
}

// The best of all guesses, and the best that is another pose: both with the markers that fit.
struct PoseChoice {
  std::vector<Sight> sights;
  Fit best, other;
};

PoseChoice choose(const std::vector<Sight>& sights, const Camera& camera) {
  std::vector<Pose> starts;
  for (const Sight& sight : sights)
    for (const Pose& pose : guesses(sight, camera)) starts.push_back(pose);
  const auto miss = [&](const Pose& pose) {
    double sum = 0;
    for (const Sight& sight : sights) sum += std::min(missOf(sight, camera, pose), kFar * kFar);
    return sum;
  };
  std::sort(starts.begin(), starts.end(),
            [&](const Pose& a, const Pose& b) { return miss(a) < miss(b); });
  PoseChoice choice;
  for (const Sight& sight : sights)
    if (missOf(sight, camera, starts[0]) < kFar * kFar) choice.sights.push_back(sight);
  choice.best.cost = choice.other.cost = INFINITY;
  if (choice.sights.empty()) return choice;
  std::vector<Fit> fits;
  for (std::size_t i = 0; i < std::min<std::size_t>(starts.size(), 4); ++i)
    fits.push_back(refined(choice.sights, camera, starts[i]));
  for (const Fit& fit : fits)
    if (fit.cost < choice.best.cost) choice.best = fit;
  for (const Fit& fit : fits)
    if (fit.cost < choice.other.cost && angleBetween(fit.pose, choice.best.pose) > kSame)
      choice.other = fit;
  return choice;
}

// How far corners are off, over what their edges allow: 1 where those hold.
double spreadOf(const PoseChoice& choice) {
  return choice.best.cost / (8 * static_cast<double>(choice.sights.size()) - 6);
}

// Takes out the marker that contradicts the others, if there are enough to say so. The others are
// asked without it: beside it they fit a pose that leans towards it.
bool dropWorst(PoseChoice& choice, const Camera& camera) {
  if (choice.sights.size() < 3 || spreadOf(choice) < kContradicts) return false;
  std::optional<PoseChoice> without;
  double least = INFINITY, next = INFINITY;
  for (std::size_t i = 0; i < choice.sights.size(); ++i) {
    std::vector<Sight> others = choice.sights;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    PoseChoice left = choose(others, camera);
    if (left.sights.size() < others.size()) continue; // leaves out more than it was asked
    const double spread = spreadOf(left);
    if (spread < least) {
      next = least;
      least = spread;
      without = std::move(left);
    } else {
      next = std::min(next, spread);
    }
  }
  // Of three, each one that is left out may leave two that fit.
  if (!without || least * kContradicts > spreadOf(choice) || 2 * least > next) return false;
  choice = std::move(*without);
  return true;
}

} // namespace

std::string_view nameOf(RigVerdict verdict) {
  switch (verdict) {
  case RigVerdict::seen:
    return "seen";
  case RigVerdict::no_marker:
    return "no marker of the rig";
  case RigVerdict::ambiguous:
    return "may be tilted either way";
  case RigVerdict::misfit:
    return "the markers are not where the rig has them";
  case RigVerdict::repeated:
    return "a marker of the rig is seen more than once";
  }
  return "";
}

std::string textOf(const RepeatedMarker& marker) {
  const std::size_t count = marker.places.size();
  std::string text = "marker " + std::to_string(marker.id) + " of " + marker.family + " is seen " +
                     (count == 2 ? "twice" : std::to_string(count) + " times") + ", at ";
  for (std::size_t i = 0; i < count; ++i)
    text += std::string(i == 0          ? ""
                        : i + 1 < count ? ", "
                                        : " and ") +
            "(" + std::to_string(std::lround(marker.places[i].x())) + ", " +
            std::to_string(std::lround(marker.places[i].y())) + ")";
  return text + " px";
}

std::string reasonOf(const SeenRig& seen) {
  return seen.verdict == RigVerdict::repeated ? textOf(seen.repeated.front())
                                              : std::string(nameOf(seen.verdict));
}

SeenRig poseOf(const std::vector<SeenMarker>& seen, const std::vector<RigMarker>& rig,
               const Camera& camera, const Pose* lately, const GreyFrame* image) {
  SeenRig result;
  const std::vector<Sight> all = sightsOf(seen, rig, result.repeated);
  if (all.empty()) {
    if (!result.repeated.empty()) result.verdict = RigVerdict::repeated;
    return result;
  }
  PoseChoice choice = choose(all, camera);
  if (!std::isfinite(choice.best.cost)) {
    result.verdict = RigVerdict::misfit;
    return result;
  }
  while (dropWorst(choice, camera)) {
  }
  result.markers = choice.sights.size();
  result.dropped = all.size() - result.markers;
  const double residuals = 8. * static_cast<double>(result.markers);
  const auto unit = [&](const Fit& fit) { // of what the edges say, from how well it fits
    return std::max(1., (kPrior + fit.cost) / (kPrior + residuals - 6));
  };
  double evidence = (choice.other.cost - choice.best.cost) / unit(choice.best); // twice a logarithm
  if (evidence < kNoDoubt && image)
    evidence =
        std::min(evidence, kMostTrust) + 2 * (faceLikeness(*image, rig, camera, choice.best.pose) -
                                              faceLikeness(*image, rig, camera, choice.other.pose));
  if (evidence < 0) std::swap(choice.best, choice.other);
  if (std::abs(evidence) < kDoubt) {
    const auto turn = [&](const Fit& fit) { return angleBetween(fit.pose, *lately); };
    if (lately && turn(choice.other) < turn(choice.best)) std::swap(choice.best, choice.other);
    if (!lately || turn(choice.best) > kOwnTurn ||
        turn(choice.other) < 2 * turn(choice.best) + kSame) {
      result.verdict = RigVerdict::ambiguous;
      return result;
    }
  }
  result.rms = rmsOf(choice.sights, camera, choice.best.pose);
  result.camera_from_probe = choice.best.pose;
  if (result.rms > kMisfit || 2 * result.dropped > all.size()) {
    result.verdict = RigVerdict::misfit;
    return result;
  }
  result.covariance = unit(choice.best) * SymmetricSolver(choice.best.normal).inverse();
  result.verdict = RigVerdict::seen;
  return result;
}

} // namespace patina
