#include "acquisition/registration/register_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "acquisition/registration/compliance_fit.h"
#include "core/numbers.h"

namespace patina {
namespace {

// Points of the first and of the final comparison.
constexpr std::size_t kAlternativeFew = 100, kMany = 400;
constexpr std::size_t kStarts = 6000, kGuesses = 100;
constexpr double kSamePose = 0.05;   // radii of the path; nearer fits are the same pose
constexpr double kNear = 0.15;       // radii; nearer fits are local minima of one pose
constexpr double kDeviations = 3;    // standard deviations; nearer poses are the same
constexpr double kLeftOut = 9;       // squared deviations at which a point is an outlier
constexpr double kSimilarCost = 0.8; // cost ratio; a lower cost differs significantly
constexpr int kWay = 8;              // steps between two poses

struct Some {
  std::vector<Vec3> points;
  std::vector<double> indentations;
};

Some someOf(const std::vector<Vec3>& points, const std::vector<double>& indentations,
            std::size_t count) {
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) finite.push_back(i);
  Some some;
  count = std::min(count, finite.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = finite[k * finite.size() / count];
    some.points.push_back(points[i]);
    if (!indentations.empty()) some.indentations.push_back(indentations[i]);
  }
  return some;
}

double between(const Pose& a, const Pose& b, const std::vector<Vec3>& points) {
  double squares = 0;
  for (const Vec3& p : points) squares += (a * p - b * p).squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

// Extrapolates the cost to all points from a subset.
double costOf(const PathFit& fit, const ResidualNoiseModel& law, std::size_t all) {
  return costOf(fit.residuals, law) * static_cast<double>(all) /
         static_cast<double>(fit.residuals.size());
}

struct FoundFit {
  PathFit fit;
  double cost;
};

PathFit fitOf(const SurfaceTarget& target, const Some& some, const Pose& from,
              const FitOptions& fitting) {
  FitOptions options = fitting;
  options.iterations = 15;
  options.indentations = some.indentations;
  return fitPath(target, some.points, from, options);
}

std::vector<SurfaceResidual> residualsAt(const SurfaceTarget& target, const Some& some,
                                         const Pose& pose) {
  std::vector<SurfaceResidual> residuals;
  for (std::size_t i = 0; i < some.points.size(); ++i) {
    residuals.push_back(target.residual(pose * some.points[i]));
    if (!some.indentations.empty()) residuals.back().distance += some.indentations[i];
  }
  return residuals;
}

// Returns true if the cost along the screw motion from one pose to another never exceeds `most`.
bool isOneValley(const SurfaceTarget& target, const Some& some, const Pose& from, const Pose& to,
                 const ResidualNoiseModel& law, double most) {
  const Pose motion = to * from.inverse();
  const Eigen::AngleAxisd turn(motion.linear());
  // Splits the motion into a rotation about the screw axis and a translation along it.
  const Vec3 along = turn.axis() * turn.axis().dot(motion.translation());
  const Vec3 aside = motion.translation() - along;
  const double half = std::tan(turn.angle() / 2);
  const Vec3 through =
      half > 1e-6 ? Vec3(0.5 * (aside + turn.axis().cross(aside) / half)) : Vec3::Zero();
  for (int step = 1; step < kWay; ++step) {
    const double part = static_cast<double>(step) / kWay;
    Pose halfway = Pose::Identity();
    halfway.linear() = Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix();
    halfway.translation() = half > 1e-6 ? Vec3(through - halfway.linear() * through + part * along)
                                        : Vec3(part * motion.translation());
    if (costOf(residualsAt(target, some, halfway * from), law) > most) return false;
  }
  return true;
}

} // namespace

std::string inWords(const std::vector<AlternativePose>& alternatives) {
  const AlternativePose& farthest =
      *std::max_element(alternatives.begin(), alternatives.end(),
                        [](const AlternativePose& a, const AlternativePose& b) {
                          return a.displacement < b.displacement;
                        });
  char turn[32];
  std::snprintf(turn, sizeof turn, "%.3g", farthest.rotation * 180 / std::numbers::pi);
  const std::string away = formatLength(farthest.displacement) + " and " + turn + " degrees away";
  if (alternatives.size() == 1) return "another place fits as well, " + away;
  return formatCount(alternatives.size()) + " other places fit as well; the farthest is " + away;
}

double costOf(const std::vector<SurfaceResidual>& residuals, const ResidualNoiseModel& law) {
  double sum = 0;
  for (const SurfaceResidual& residual : residuals) {
    const double deviations = residual.distance / law.deviation;
    sum += std::min(deviations * deviations, kLeftOut);
  }
  return sum / law.correlation_length;
}

bool isNear(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points) {
  return between(mesh_from_path, other, points) < kNear * scaleOf(points, mesh_from_path).radius;
}

bool isSamePose(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points) {
  return between(mesh_from_path, other, points) <
         kSamePose * scaleOf(points, mesh_from_path).radius;
}

std::vector<Pose> globalCandidates(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                   const Pose& pose, const FitOptions& fitting,
                                   Progress& progress) {
  const PoseScaling scale = scaleOf(points, pose);
  const Box3 box = bounds(target.mesh());
  Pose middle = pose;
  middle.translation() += box.center() - scale.centre;
  const Some few = someOf(points, fitting.indentations, kAlternativeFew);
  std::vector<Pose> places;
  for (const Pose& guess :
       coarsePoses(target, points, middle,
                   {std::numbers::pi, box.sizes().norm() / 2, kGuesses, kStarts}, progress)) {
    progress.throwIfCancelled();
    const Pose place = fitOf(target, few, guess, fitting).mesh_from_path;
    if (std::none_of(places.begin(), places.end(), [&](const Pose& other) {
          return between(other, place, few.points) < kSamePose * scale.radius / 2;
        }))
      places.push_back(place);
  }
  return places;
}

std::vector<AlternativePose> alternativePoses(const SurfaceTarget& target,
                                              const std::vector<Vec3>& points,
                                              const std::vector<Pose>& places, const PathFit& best,
                                              const FitOptions& fitting,
                                              const ResidualNoiseModel& law,
                                              const UnobservableMotions& free, Progress& progress) {
  const double radius = scaleOf(points, best.mesh_from_path).radius;
  const Some few = someOf(points, fitting.indentations, kAlternativeFew),
             many = someOf(points, fitting.indentations, kMany);
  const double same =
      std::max(kSamePose * radius, kDeviations * std::sqrt(law.covariance(free.basis).trace()));
  const PathFit start = fitOf(target, many, best.mesh_from_path, fitting);
  const double here = costOf(start, law, points.size()), most = here + kChi2Quantile6;
  const double roughly = 2 * here + 4 * kChi2Quantile6; // with a margin for the small subset
  std::vector<FoundFit> found;
  for (const Pose& place : places) {
    progress.throwIfCancelled();
    const double rough = costOf(residualsAt(target, few, place), law) *
                         static_cast<double>(points.size()) /
                         static_cast<double>(few.points.size());
    if (rough > roughly) continue;
    PathFit fit = fitOf(target, many, place, fitting);
    const double cost = costOf(fit, law, points.size());
    if (cost > most) continue;
    const double away = between(fit.mesh_from_path, best.mesh_from_path, many.points);
    if (away < same && cost > here - 1e-2) continue;
    const auto twin = std::find_if(found.begin(), found.end(), [&](const FoundFit& other) {
      return between(other.fit.mesh_from_path, fit.mesh_from_path, many.points) < same;
    });
    if (twin == found.end())
      found.push_back({std::move(fit), cost});
    else if (cost < twin->cost)
      *twin = {std::move(fit), cost};
  }
  std::vector<AlternativePose> alternatives;
  std::sort(found.begin(), found.end(),
            [](const FoundFit& a, const FoundFit& b) { return a.cost < b.cost; });
  const double stands_for =
      static_cast<double>(points.size()) / static_cast<double>(many.points.size());
  for (const FoundFit& one : found) {
    // Along unobservable directions the ends differ by chance, without a higher cost in between.
    if (one.cost > here && isNear(best.mesh_from_path, one.fit.mesh_from_path, many.points) &&
        isOneValley(target, many, best.mesh_from_path, one.fit.mesh_from_path, law,
                    (one.cost + kChi2Quantile6) / stands_for))
      continue;
    const double chance = 1.25 * std::max(one.cost, here) + kChi2Quantile6;
    if (free.basis.cols() > 0 && one.cost > std::max(here - kChi2Quantile6, kSimilarCost * here) &&
        isOneValley(target, many, best.mesh_from_path, one.fit.mesh_from_path, law,
                    chance / stands_for))
      continue;
    const Pose& pose = one.fit.mesh_from_path;
    const auto counts = static_cast<double>(std::count_if(
        one.fit.weights.begin(), one.fit.weights.end(), [](double w) { return w > 0; }));
    alternatives.push_back(
        {pose, one.fit.rms,
         static_cast<std::size_t>(std::lround(counts * static_cast<double>(points.size()) /
                                              static_cast<double>(many.points.size()))),
         between(pose, best.mesh_from_path, many.points),
         Eigen::AngleAxisd((pose * best.mesh_from_path.inverse()).linear()).angle(),
         here - one.cost});
  }
  return alternatives;
}

namespace {

constexpr double kMaxRmsRatio = 1.5; // times the noise: a larger rms indicates a wrong pose
constexpr std::size_t kSubset = 600; // points that compare candidate poses
constexpr int kMoreFits = 3;
constexpr double kRound = 5e-3;     // noise over the points' radius without bias by curvature
constexpr double kCostRatio = 0.99; // cost ratio of a distinctly better fit

double inlierShare(const PathFit& fit) {
  return static_cast<double>(std::count_if(fit.weights.begin(), fit.weights.end(),
                                           [](double w) { return w > 0; })) /
         static_cast<double>(fit.weights.size());
}

// Truncated cost: residuals are capped at `far`.
double truncatedCost(const PathFit& fit, double far) {
  double sum = 0;
  for (const SurfaceResidual& residual : fit.residuals)
    sum += std::min(residual.distance * residual.distance, far * far);
  return sum;
}

struct Downsampled {
  std::vector<Vec3> points;
  std::vector<std::size_t> of; // index into `points` for each point

  std::vector<double> meansOf(const std::vector<double>& values) const {
    std::vector<double> means(values.empty() ? 0 : points.size(), 0), counts(means.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      means[of[i]] += (values[i] - means[of[i]]) / ++counts[of[i]];
    return means;
  }
};

Downsampled downsampledPath(const std::vector<Vec3>& points, const std::vector<std::size_t>& scan,
                            double reach) {
  Downsampled places;
  Vec3 first = Vec3::Zero();
  double count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& point = points[i];
    const bool begins = i > 0 && !scan.empty() && scan[i] != scan[i - 1];
    if (count == 0 || begins || !((point - first).norm() < reach)) {
      first = point;
      count = 0;
      places.points.push_back(Vec3::Zero());
    }
    places.points.back() += (point - places.points.back()) / ++count;
    places.of.push_back(places.points.size() - 1);
  }
  return places;
}

Registration registerPlaces(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& start, RegistrationOptions options, Progress& progress) {
  const Downsampled places = downsampledPath(points, options.scan, options.sample_spacing);
  std::vector<double> indentations =
      std::exchange(options.indentations, places.meansOf(options.indentations));
  const ScanForces forces(options.force, options.scan);
  options.force = places.meansOf(options.force);
  std::vector<std::size_t> scan(options.scan.empty() ? 0 : places.points.size());
  for (std::size_t i = 0; i < options.scan.size(); ++i) scan[places.of[i]] = options.scan[i];
  options.scan = std::move(scan);
  options.sample_spacing = 0;
  Registration found = registerPath(target, places.points, start, options, progress);
  if (forces.scans() > 0) indentations = forces.indentations(found.compliances);
  std::vector<SurfaceResidual> residuals;
  std::vector<bool> inliers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = places.of[i];
    residuals.push_back(
        target.residual(found.mesh_from_path * points[i], found.residuals[place].foot.face));
    if (!indentations.empty()) residuals.back().distance += indentations[i];
    inliers.push_back(found.inliers[place]);
  }
  found.correlation_length *= // correlation in downsampled points
      static_cast<double>(points.size()) / static_cast<double>(places.points.size());
  found.residuals = std::move(residuals);
  found.inliers = std::move(inliers);
  return found;
}

// Removes the bias by curvature. The mean distance of noisy points about a point of mean curvature
// H is noise^2 H (the distance's Laplacian), which the fit would compensate. The mean is taken over
// six points, exact for normal noise to the third degree. The target must have sides.
PathFit fitLessBias(const SurfaceTarget& target, const std::vector<Vec3>& points, PathFit best,
                    const FitOptions& fitting, double noise) {
  std::vector<double> bias(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (best.weights[i] == 0) continue;
    const SurfaceResidual& residual = best.residuals[i];
    const Vec3 place = residual.at + target.offset() * residual.direction;
    for (int k = 0; k < 6; ++k) {
      const Vec3 aside = (k % 2 ? 1 : -1) * std::sqrt(3.) * noise * Vec3::Unit(k / 2);
      bias[i] += target.residual(place + aside, residual.foot.face).distance / 6;
    }
  }
  FitOptions unbiased = fitting;
  unbiased.indentations.resize(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) unbiased.indentations[i] -= bias[i];
  const int iterations = best.iterations;
  PathFit fit = fitPath(target, points, best.mesh_from_path, unbiased);
  fit.iterations += iterations;
  for (std::size_t i = 0; i < points.size(); ++i) fit.residuals[i].distance += bias[i];
  return fit;
}

} // namespace

double pathDeviation(const Registration& found) {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const SurfaceResidual& residual : found.residuals) {
    const Vec3 arm = residual.at - found.middle;
    moment += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
  }
  moment /= std::max<double>(1, static_cast<double>(found.residuals.size()));
  const Eigen::Matrix3d turn = found.covariance.topLeftCorner<3, 3>();
  return std::sqrt(std::max(0., turn.cwiseProduct(moment).sum() +
                                    found.covariance.bottomRightCorner<3, 3>().trace()));
}

double minNoise(const std::vector<Vec3>& points, double noise) {
  return std::max(noise, 1e-4 * scaleOf(points, Pose::Identity()).radius);
}

bool isConsistentWithNoise(double rms, double share, double noise, double least, double outliers) {
  return share >= 1 - outliers && (noise <= 0 || rms <= kMaxRmsRatio * least);
}

Registration registerPath(const SurfaceTarget& target, const std::vector<Vec3>& points,
                          const Pose& start, const RegistrationOptions& options,
                          Progress& progress) {
  if (!options.indentations.empty() && options.indentations.size() != points.size())
    throw std::invalid_argument("registerPath: a depth for each point, or none");
  if (!options.force.empty() &&
      (options.force.size() != points.size() || !options.indentations.empty()))
    throw std::invalid_argument("registerPath: a force for each point and no depth, or none");
  if (!options.scan.empty() && options.scan.size() != points.size())
    throw std::invalid_argument("registerPath: a scan's number for each point, or none");
  if (options.sample_spacing > 0) return registerPlaces(target, points, start, options, progress);
  const double least = minNoise(points, options.noise);
  // Returns true if the fit is consistent with the noise; without a noise only an exact fit is.
  const auto isGood = [&](const PathFit& fit) {
    return isConsistentWithNoise(fit.rms, inlierShare(fit), least, least, options.outliers);
  };
  FitOptions fitting;
  fitting.indentations = options.indentations;
  Registration result;
  result.starts = 0;
  const auto fitFrom = [&](const Pose& from, const std::vector<Vec3>& some) {
    PathFit fit = fitPath(target, some, from, fitting);
    ++result.starts;
    result.iterations += fit.iterations;
    result.evaluations += fit.evaluations;
    return fit;
  };
  progress.report(0, "fit");
  PathFit best = fitFrom(start, points); // sufficient for a good start pose
  fitting.noise = options.robust ? least : 0;
  if (options.robust && !isGood(best)) best = fitFrom(start, points);
  const bool anywhere = !(options.search_options.rotation < std::numbers::pi);
  if (options.search && !isGood(best) && !(options.alternatives && anywhere)) {
    progress.report(0.2, "search");
    const double far = 4 * std::max(options.noise, 10 * minNoise(points, 0));
    const std::vector<Pose> guesses =
        coarsePoses(target, points, start, options.search_options, progress);
    // A subset of the points decides among the candidates.
    std::vector<Vec3> few;
    std::vector<double> few_indentations;
    const std::size_t step = points.size() / kSubset + 1;
    for (std::size_t i = 0; i < points.size(); i += step) {
      while (i + 1 < points.size() && !points[i].allFinite()) ++i;
      few.push_back(points[i]);
      if (!options.indentations.empty()) few_indentations.push_back(options.indentations[i]);
    }
    std::swap(fitting.indentations, few_indentations);
    PathFit nearest = fitFrom(best.mesh_from_path, few);
    for (const Pose& guess : guesses) {
      progress.throwIfCancelled();
      PathFit fit = fitFrom(guess, few);
      if (truncatedCost(fit, far) < kCostRatio * truncatedCost(nearest, far))
        nearest = std::move(fit);
    }
    std::swap(fitting.indentations, few_indentations);
    best = fitFrom(nearest.mesh_from_path, points);
  }
  const auto noiseOf = [&](const PathFit& fit) { return std::max(fit.rms, least); };
  ResidualNoiseModel law;
  UnobservableMotions free;
  FitOptions compliant = fitting; // with the indentations at `best`
  const ScanForces forces(options.force, options.scan, options.expected);
  const auto judge = [&] {
    law = fitNoiseModel(points, best, noiseOf(best), forces);
    if (forces.scans() > 0) {
      ComplianceFit found =
          fitPoseAndCompliance(target, points, forces, best, law.correlation_length, fitting);
      best = std::move(found.fit);
      result.compliances = found.compliances;
      law = fitNoiseModel(points, best, noiseOf(best), forces);
      compliant.indentations = forces.indentations(result.compliances);
    }
    free = unobservableMotions(target, points, best, noiseOf(best), law.correlation_length,
                               compliant.indentations);
    addPoorlyKnown(free, law, scaleOf(points, best.mesh_from_path));
  };
  judge();
  if (options.alternatives) {
    progress.report(0.5, "other places");
    // The start pose decides between equally likely poses.
    const double better = anywhere ? 0 : kChi2Quantile6;
    std::vector<Pose> places =
        globalCandidates(target, points, best.mesh_from_path, compliant, progress);
    for (int round = 0;; ++round) {
      result.alternatives =
          alternativePoses(target, points, places, best, compliant, law, free, progress);
      result.starts += static_cast<int>(places.size());
      if (round == 3 || result.alternatives->empty() || result.alternatives->front().cost_gain <= 0)
        break;
      places.push_back(best.mesh_from_path);
      const PathFit here = best;
      best = fitFrom(result.alternatives->front().mesh_from_path, points);
      judge();
      // Uses the better pose's noise model: a misfit at a wrong pose looks like correlated noise.
      const double gain = costOf(here.residuals, law) - costOf(best.residuals, law);
      if (gain > (isNear(here.mesh_from_path, best.mesh_from_path, points) ? 0 : better)) continue;
      best = here;
      judge();
      break;
    }
  }
  // A long flat valley needs more steps than one fit has.
  for (int again = 0; again < kMoreFits && !best.converged; ++again) {
    best = fitFrom(best.mesh_from_path, points);
    judge();
  }
  if (target.hasSides() && options.noise > kRound * scaleOf(points, best.mesh_from_path).radius)
    best = fitLessBias(target, points, std::move(best), compliant, std::min(best.rms, least));
  const PoseScaling scale = scaleOf(points, best.mesh_from_path);
  result.mesh_from_path = best.mesh_from_path;
  result.rms = best.rms;
  result.noise = noiseOf(best);
  result.correlation_length = law.correlation_length;
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < best.residuals.size(); ++i) {
    result.inliers.push_back(best.weights[i] > 0);
    if (best.weights[i] == 0) continue;
    sum += std::abs(best.residuals[i].distance);
    ++n;
  }
  result.mean_distance = sum / std::max(n, 1.0);
  result.covariance = law.covariance(free.basis);
  if (forces.scans() > 0) {
    const MatX whole = law.wholeCovariance(free.basis);
    for (std::size_t s = 0; s < forces.scans(); ++s) {
      const auto row = static_cast<Eigen::Index>(6 + s);
      const double usual = forces.rmsForce(s);
      result.compliance_deviations.push_back(usual > 0
                                                 ? std::sqrt(std::max(0., whole(row, row))) / usual
                                                 : ExpectedCompliance{}.deviation);
    }
  }
  result.covariance.topRows<3>() /= scale.radius;
  result.covariance.leftCols<3>() /= scale.radius;
  result.free = std::move(free.named);
  result.middle = scale.centre;
  result.last_rotation = best.last_rotation;
  result.last_translation = best.last_translation;
  result.converged = best.converged &&
                     isConsistentWithNoise(best.rms, inlierShare(best), options.noise,
                                           std::hypot(least, options.roughness), options.outliers);
  if (options.noise > 0)
    result.roughness = std::sqrt(std::max(0., best.rms * best.rms - least * least));
  result.residuals = std::move(best.residuals);
  return result;
}

} // namespace patina
