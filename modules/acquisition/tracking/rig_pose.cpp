#include "acquisition/tracking/rig_pose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/tracking/edge_fit.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_code.h"
#include "acquisition/tracking/marker_residual.h"
#include "acquisition/values/camera.h"
#include "core/decompose.h"

namespace patina {
namespace {

// Likelihood of a pose by the appearance of all faces, even those too small to decode (A04).

constexpr double kMinWide = 2;    // smallest width of a compared marker [px]
constexpr double kBlurred = 4;    // number of pixels per independent sample, by blur
constexpr double kSharpest = 0.9; // largest correlation counted; beyond it light and print matter

double areaOf(const Quad& q) {
  return 0.5 * (cross(q[1] - q[0], q[2] - q[0]) + cross(q[2] - q[0], q[3] - q[0]));
}

// Returns the printed color, with a white ring around the black border.
bool isWhite(const MarkerFamily& family, std::uint64_t code, int x, int y) {
  const int all = family.side + 4, ring = std::min({x, y, all - 1 - x, all - 1 - y});
  if (ring < 2) return ring == 0;
  const int bit = (y - 2) * family.side + x - 2;
  return code >> (family.side * family.side - 1 - bit) & 1;
}

double likenessOf(const GreyFrame& image, const RigMarker& marker, const Camera& camera,
                  const Pose& pose) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = pose * marker.corners()[i];
    if (!(p.z() > 1e-6)) return 0;
    quad[i] = pixelOf(camera, p);
  }
  // The corners are clockwise unless the back of the marker is seen.
  const double area = areaOf(quad);
  const double longest = std::max((quad[2] - quad[0]).norm(), (quad[3] - quad[1]).norm());
  if (!(area > kMinWide * longest)) return 0;
  const MarkerFamily& family = markerFamily(marker.family);
  const int all = family.side + 4;
  const double cell = marker.size / (family.side + 2);
  double n = 0, print = 0, grey = 0, both = 0, prints = 0, greys = 0;
  for (int y = 0; y < all; ++y)
    for (int x = 0; x < all; ++x) {
      const Vec3 place(-marker.size / 2 + (x - 0.5) * cell, marker.size / 2 - (y - 0.5) * cell, 0);
      const Vec3 p = pose * (marker.probe_from_marker * place);
      if (!(p.z() > 1e-6)) return 0;
      const Vec2 pixel = pixelOf(camera, p);
      const auto g = greyAt(image, pixel.x(), pixel.y());
      if (!g) return 0; // partly outside the picture
      const double w =
          isWhite(family, family.code[static_cast<std::size_t>(marker.id)], x, y) ? 1 : 0;
      n += 1, print += w, grey += *g, both += w * *g, prints += w * w, greys += *g * *g;
    }
  const double spread = (prints - print * print / n) * (greys - grey * grey / n);
  if (!(spread > 0)) return 0;
  const double correlation =
      std::clamp((both - print * grey / n) / std::sqrt(spread), 0., kSharpest);
  // Log likelihood ratio of a regression over this number of independent pixels.
  return -0.5 * std::min(n, area / kBlurred) * std::log(1 - correlation * correlation);
}

// Returns the log likelihood ratio of the picture between the rig in this pose and no marker at
// all; 0 if no marker would be visible.
double appearanceLogRatio(const GreyFrame& image, const std::vector<RigMarker>& rig,
                          const Camera& camera, const Pose& camera_from_probe) {
  double sum = 0;
  for (const RigMarker& marker : rig) sum += likenessOf(image, marker, camera, camera_from_probe);
  return sum;
}

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kFar = 10;           // largest error of a marker at an initial guess [px]
constexpr double kMisfit = 2;         // largest rms of a correct rig [px]
constexpr double kPriorResiduals = 8; // weight of the edges' own deviations, in residuals
constexpr double kMinCostGap = 12;    // smallest cost gap to another pose
// Cost gap above which the faces' appearance is not needed, and the largest evidence of the edges
// otherwise, because of their systematic errors.
constexpr double kCertainGap = 150, kMaxEvidence = 24;
constexpr double kContradicts = 6; // spread ratio that identifies a wrong marker
constexpr double kSame = 0.05;     // smaller rotations are the same pose [rad]
constexpr double kOwnTurn = 0.3;   // largest rotation of a hand between frames [rad]

// A detected marker and its corners on the rig.
struct MarkerObservation {
  const SeenMarker* seen;
  std::array<Vec3, 4> corner; // in the probe's frame
  const RigMarker* marker;
};

Vec2 pinhole(const Camera& camera, const Vec3& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

// Returns the mean squared reprojection error of the corners [px^2].
double reprojectionError(const MarkerObservation& observation, const Camera& camera,
                         const Pose& pose) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = pose * observation.corner[i];
    if (!(p.z() > 1e-6)) return 1e12;
    sum += (pinhole(camera, p) - observation.seen->corner[i].undistorted).squaredNorm() / 4;
  }
  return sum;
}

struct Fit {
  Pose pose;
  double cost = 0; // sum of squared residuals, each over its deviation
  Mat6 normal = Mat6::Zero();
};

// Computes residuals of the corners and their derivatives by motions in the camera's frame.
Fit linearised(const std::vector<MarkerObservation>& observations, const Camera& camera,
               const Pose& pose, Vec6& gradient) {
  Fit fit{pose};
  gradient.setZero();
  for (const MarkerObservation& observation : observations)
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 arm = pose.linear() * observation.corner[i], p = arm + pose.translation();
      if (!(p.z() > 1e-6)) {
        fit.cost = INFINITY;
        return fit;
      }
      const FittedCorner& corner = observation.seen->corner[i];
      const Vec2 e = corner.whiten * (pinhole(camera, p) - corner.undistorted);
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

// Levenberg-Marquardt.
Fit refined(const std::vector<MarkerObservation>& observations, const Camera& camera,
            const Pose& start) {
  Vec6 gradient, next_gradient;
  Fit fit = linearised(observations, camera, start, gradient);
  double damping = 1e-4;
  for (int i = 0; i < 40 && damping < 1e8; ++i) {
    Mat6 damped = fit.normal;
    damped.diagonal() *= 1 + damping;
    const Vec6 step = -SymmetricSolver(damped).solve(gradient);
    const Fit next = linearised(observations, camera, movedPose(fit.pose, step), next_gradient);
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

// Returns both poses of one marker from its homography. The second solution has the normal mirrored
// at the line of sight (planar pose ambiguity: Schweighofer & Pinz 2006, Collins & Bartoli 2014).
std::array<Pose, 2> guesses(const MarkerObservation& observation, const Camera& camera) {
  Quad flat;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2& p = observation.seen->corner[i].undistorted;
    flat[i] = {(p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy};
  }
  const Eigen::Matrix3d map = homographyTo(flat);
  const double size = observation.marker->size;
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
  other.linear() = rotationFromTo(normal, mirrored).toRotationMatrix() * one.linear();
  const Pose marker_from_probe = observation.marker->probe_from_marker.inverse();
  return {one * marker_from_probe, other * marker_from_probe};
}

Vec2 centreOf(const SeenMarker& marker) {
  Vec2 sum = Vec2::Zero();
  for (const FittedCorner& corner : marker.corner) sum += corner.pixel;
  return sum / 4;
}

// A marker that is detected more than once has at least one wrong detection; none is used.
std::vector<MarkerObservation> observationsOf(const std::vector<SeenMarker>& seen,
                                              const std::vector<RigMarker>& rig,
                                              std::vector<RepeatedMarker>& repeated) {
  std::vector<MarkerObservation> observations;
  for (const RigMarker& marker : rig) {
    const auto is = [&](const SeenMarker& s) {
      return s.id == marker.id && s.family == marker.family;
    };
    std::vector<const SeenMarker*> images;
    for (const SeenMarker& image : seen)
      if (is(image)) images.push_back(&image);
    if (images.size() == 1) observations.push_back({images[0], marker.corners(), &marker});
    if (images.size() < 2) continue;
    repeated.push_back({marker.family, marker.id, {}});
    for (const SeenMarker* image : images) repeated.back().places.push_back(centreOf(*image));
  }
  return observations;
}

// Corners are weighted by their accuracy, which is low on faces seen edge on.
double rmsOf(const std::vector<MarkerObservation>& observations, const Camera& camera,
             const Pose& pose) {
  double sum = 0, weights = 0;
  for (const MarkerObservation& observation : observations)
    for (std::size_t i = 0; i < 4; ++i) {
      const FittedCorner& corner = observation.seen->corner[i];
      const Vec2 residual = pinhole(camera, pose * observation.corner[i]) - corner.undistorted;
      sum += 2 * (corner.whiten * residual).squaredNorm();
      weights += corner.whiten.squaredNorm();
    }
  return std::sqrt(sum / weights);
}

// The best of all poses and the best different pose, both with the same inliers.
struct PoseChoice {
  std::vector<MarkerObservation> observations;
  Fit best, other;
};

PoseChoice choose(const std::vector<MarkerObservation>& observations, const Camera& camera) {
  std::vector<Pose> starts;
  for (const MarkerObservation& observation : observations)
    for (const Pose& pose : guesses(observation, camera)) starts.push_back(pose);
  const auto costOf = [&](const Pose& pose) {
    double sum = 0;
    for (const MarkerObservation& observation : observations)
      sum += std::min(reprojectionError(observation, camera, pose), kFar * kFar);
    return sum;
  };
  std::sort(starts.begin(), starts.end(),
            [&](const Pose& a, const Pose& b) { return costOf(a) < costOf(b); });
  PoseChoice choice;
  for (const MarkerObservation& observation : observations)
    if (reprojectionError(observation, camera, starts[0]) < kFar * kFar)
      choice.observations.push_back(observation);
  choice.best.cost = choice.other.cost = INFINITY;
  if (choice.observations.empty()) return choice;
  std::vector<Fit> fits;
  for (std::size_t i = 0; i < std::min<std::size_t>(starts.size(), 4); ++i)
    fits.push_back(refined(choice.observations, camera, starts[i]));
  for (const Fit& fit : fits)
    if (fit.cost < choice.best.cost) choice.best = fit;
  for (const Fit& fit : fits)
    if (fit.cost < choice.other.cost && angleBetween(fit.pose, choice.best.pose) > kSame)
      choice.other = fit;
  return choice;
}

// Returns the mean squared residual per degree of freedom; 1 if the edges' deviations are right.
double spreadOf(const PoseChoice& choice) {
  return choice.best.cost / (8 * static_cast<double>(choice.observations.size()) - 6);
}

// Removes the marker that contradicts the others, if there are enough. The others are fitted
// without it, because it would bias their pose.
bool removeWorstOutlier(PoseChoice& choice, const Camera& camera) {
  if (choice.observations.size() < 3 || spreadOf(choice) < kContradicts) return false;
  std::optional<PoseChoice> without;
  double least = INFINITY, next = INFINITY;
  for (std::size_t i = 0; i < choice.observations.size(); ++i) {
    std::vector<MarkerObservation> others = choice.observations;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    PoseChoice left = choose(others, camera);
    if (left.observations.size() < others.size()) continue; // has other outliers
    const double spread = spreadOf(left);
    if (spread < least) {
      next = least;
      least = spread;
      without = std::move(left);
    } else {
      next = std::min(next, spread);
    }
  }
  // Any two of three markers may be consistent.
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
               const Camera& camera, const Pose* previous_pose, const GreyFrame* image) {
  SeenRig result;
  const std::vector<MarkerObservation> all = observationsOf(seen, rig, result.repeated);
  if (all.empty()) {
    if (!result.repeated.empty()) result.verdict = RigVerdict::repeated;
    return result;
  }
  PoseChoice choice = choose(all, camera);
  if (!std::isfinite(choice.best.cost)) {
    result.verdict = RigVerdict::misfit;
    return result;
  }
  while (removeWorstOutlier(choice, camera)) {
  }
  result.markers = choice.observations.size();
  result.dropped = all.size() - result.markers;
  for (const MarkerObservation& observation : choice.observations)
    result.used.push_back(static_cast<std::size_t>(observation.marker - rig.data()));
  const double residuals = 8. * static_cast<double>(result.markers);
  const auto unit = [&](const Fit& fit) { // scale of the edges' variances, from the fit
    return std::max(1., (kPriorResiduals + fit.cost) / (kPriorResiduals + residuals - 6));
  };
  // Difference of -2 log likelihood.
  double evidence = (choice.other.cost - choice.best.cost) / unit(choice.best);
  if (evidence < kCertainGap && image)
    evidence = std::min(evidence, kMaxEvidence) +
               2 * (appearanceLogRatio(*image, rig, camera, choice.best.pose) -
                    appearanceLogRatio(*image, rig, camera, choice.other.pose));
  if (evidence < 0) std::swap(choice.best, choice.other);
  if (std::abs(evidence) < kMinCostGap) {
    const auto turn = [&](const Fit& fit) { return angleBetween(fit.pose, *previous_pose); };
    if (previous_pose && turn(choice.other) < turn(choice.best))
      std::swap(choice.best, choice.other);
    if (!previous_pose || turn(choice.best) > kOwnTurn ||
        turn(choice.other) < 2 * turn(choice.best) + kSame) {
      result.verdict = RigVerdict::ambiguous;
      return result;
    }
  }
  result.rms = rmsOf(choice.observations, camera, choice.best.pose);
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
