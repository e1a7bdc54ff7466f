#include "acquisition/registration/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "acquisition/loaded/solver_library.h"
#include "acquisition/registration/local_motion.h"
#include "acquisition/registration/unobservable_motions.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr int kSteps = 40;
constexpr double kSettledScale = 1e-4;
constexpr double kMaxStep = 0.1;      // largest step of the scale's logarithm
constexpr double kSettledShare = 0.3; // largest last step, over the scale's deviation
constexpr int kSelections = 5;        // most times that the inliers are selected
// Largest component of the scale in a direction that the points leave unobservable.
constexpr double kUnobservableScale = 1e-2;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Selects the inliers of a fit by its own residuals. Returns true if they change.
bool selectAgain(PathFit& fit, double noise) {
  std::vector<double> sizes;
  for (const SurfaceResidual& residual : fit.residuals)
    sizes.push_back(std::abs(residual.distance));
  const double most = inlierThreshold(sizes, noise);
  const std::vector<double> before = fit.weights;
  for (std::size_t i = 0; i < sizes.size(); ++i) fit.weights[i] = sizes[i] <= most ? 1 : 0;
  return fit.weights != before;
}

} // namespace

SimilarityFit fitSimilarity(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& mesh_from_path, const std::vector<bool>& inliers,
                            const std::vector<double>& indentations, double noise) {
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  const PoseScaling whole = scaleOf(points, Pose::Identity());
  SimilarityFit fit;
  fit.mesh_from_path = mesh_from_path;
  std::vector<Vec3> scaled = points;
  PathFit left; // result of this fit
  left.residuals.resize(points.size());
  left.weights.assign(inliers.begin(), inliers.end());
  int selections = 0;
  double variance = 0, radius = 1; // variance over that of a point
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t i = 0; i < points.size(); ++i)
      scaled[i] = whole.centre + fit.scale * (points[i] - whole.centre);
    const PoseScaling scale = scaleOf(scaled, fit.mesh_from_path);
    left.mesh_from_path = fit.mesh_from_path;
    radius = scale.radius;
    Mat7 normal = Mat7::Zero();
    Vec7 right = Vec7::Zero();
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 p = fit.mesh_from_path * scaled[i];
      SurfaceResidual& residual = left.residuals[i];
      residual = target.residual(p, residual.foot.face);
      if (!indentations.empty()) residual.distance += indentations[i];
      if (left.weights[i] == 0) continue;
      Vec7 g;
      g << scale.gradient(p, residual.direction),
          residual.direction.dot(p - scale.centre) / scale.radius;
      normal += g * g.transpose();
      right -= residual.distance * g;
      squares += residual.distance * residual.distance;
      ++n;
    }
    const SymmetricEigen eigen(normal);
    Vec7 change = Vec7::Zero();
    variance = 0;
    for (int k = 0; k < 7; ++k) {
      if (!(eigen.values[k] > kRankTolerance * eigen.values[6])) {
        if (std::abs(eigen.vectors(6, k)) > kUnobservableScale) variance = kInfinite;
        continue;
      }
      change += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
      variance += eigen.vectors(6, k) * eigen.vectors(6, k) / eigen.values[k];
    }
    fit.rms = left.rms = std::sqrt(squares / std::max(n, 1.));
    const double growth = std::clamp(change[6] / scale.radius, -kMaxStep, kMaxStep);
    Vec6 motion = change.head<6>();
    limit(motion, scale, target.extent());
    // Facets keep the step from vanishing. The last one is left out, so that the residuals are
    // those of the pose.
    const double deviation = std::isfinite(variance) ? fit.rms * std::sqrt(variance) : 0;
    const double moved = std::max(std::abs(growth) * radius, motion.norm());
    fit.converged = moved < std::max(kSettledScale * radius, kSettledShare * deviation) &&
                    (++selections == kSelections || !selectAgain(left, noise));
    if (fit.converged) break;
    fit.mesh_from_path = scale.motion(motion) * fit.mesh_from_path;
    fit.scale *= std::exp(growth);
  }
  const ResidualNoiseModel law = fitNoiseModel(scaled, left, noise);
  fit.deviation = law.deviation * std::sqrt(law.correlation_length * variance) / radius;
  fit.residuals = std::move(left.residuals);
  return fit;
}

namespace {

// Largest deviation of an observable direction, in units of the noise.
constexpr double kJointMaxDeviation = 10;
constexpr int kJointMostSteps = 30, kJointRecounts = 5, kJointPlaces = 3;
constexpr double kJointSettled = 1e-2; // tolerance of a step over its deviation
// Smallest ratio of the clock's information to that of the force's noise.
constexpr double kJointMinInformation = 10;
// A message names the components whose squared share of a direction exceeds this.
constexpr double kJointNamed = 0.15;

struct Values {
  Pose pose;
  Vec3 tip = Vec3::Zero();
  double clock = 0;
};

struct Joint {
  const SurfaceTarget& target;
  const std::vector<PathSample>& path;
  double compliance;
  std::vector<LocalMotion> motions;
  std::vector<std::size_t> inlier_samples{}; // sample indices of the inliers
  double speed = 1;                          // conversion of the clock's offset to a length [m/s]
  Values here{};
  PoseScaling scale{};
  // Orthonormal search directions in scaled parameters; Ceres optimises the step along each.
  Eigen::Matrix<double, kJointValues, Eigen::Dynamic> directions{};
  // Residuals of the inliers, and the step from `here` at which they were evaluated.
  std::vector<SurfaceResidual> surface_residuals{};
  JointVector residuals_at = JointVector::Constant(std::nan(""));

  // Returns the probe's pose at the time when the sample's force was measured.
  PathSample felt(std::size_t i) const {
    const LocalMotion& motion = motions[i];
    PathSample sample = path[i];
    const Vec3 turn = here.clock * motion.angular_velocity;
    if (const double angle = turn.norm(); angle > 0)
      sample.orientation = Eigen::AngleAxisd(angle, turn / angle) * sample.orientation;
    sample.position += here.clock * (motion.velocity + 0.5 * here.clock * motion.acceleration) +
                       sample.orientation * here.tip;
    return sample;
  }
  // Keeps the measured positions and looks up the force at the shifted time. A clock offset is
  // observable only through the compliance, and the force is less noisy than the path's velocity.
  Vec3 place(std::size_t i, const Vec3& tip) const {
    return path[i].position + path[i].orientation * tip;
  }
  Values after(const JointVector& lengths) const {
    return {scale.motion(lengths.head<6>()) * here.pose, here.tip + lengths.segment<3>(6),
            here.clock + lengths[9] / speed};
  }
  // Moves the origin by this step along the directions.
  void go(const double* gone) {
    const JointVector lengths = directions * Eigen::Map<const VecX>(gone, directions.cols());
    here = after(lengths);
    residuals_at -= lengths;
    std::vector<Vec3> places;
    for (const std::size_t i : inlier_samples) places.push_back(place(i, here.tip));
    scale = scaleOf(places, here.pose);
  }
  // Computes the inliers' distances and, unless nullptr, their derivatives along the directions.
  void evaluate(const double* gone, double* distances, double* slopes) {
    const JointVector lengths = directions * Eigen::Map<const VecX>(gone, directions.cols());
    const Values at = after(lengths);
    if (residuals_at != lengths)
      for (std::size_t k = 0; k < inlier_samples.size(); ++k)
        surface_residuals[k] = target.residual(at.pose * place(inlier_samples[k], at.tip),
                                               surface_residuals[k].foot.face);
    residuals_at = lengths;
    const PoseScaling there{scale.centre + lengths.segment<3>(3), scale.radius};
    // A change dw of the rotation vector w is followed by the rotation J dw. J, the left Jacobian
    // of SO(3), is the mean of the rotations from 0 to w: by Simpson's rule, to 1e-6 up to 0.25
    // rad.
    const Vec6 half = lengths.head<6>() / 2;
    auto along = directions;
    along.topRows<3>() += (4 * scale.motion(half).linear() + scale.motion(2 * half).linear() -
                           5 * Eigen::Matrix3d::Identity()) /
                          6 * directions.topRows<3>();
    for (std::size_t k = 0; k < inlier_samples.size(); ++k) {
      const std::size_t i = inlier_samples[k];
      SmoothForce force;
      if (compliance > 0) force = forceBefore(path, motions, i, at.clock);
      distances[k] = surface_residuals[k].distance + compliance * force.force;
      if (!slopes) continue;
      JointVector g;
      g << there.gradient(at.pose * place(i, at.tip), surface_residuals[k].direction),
          path[i].orientation.conjugate() *
              (at.pose.linear().transpose() * surface_residuals[k].direction),
          -compliance * force.force_rate / speed;
      Eigen::Map<VecX>(slopes, along.cols()).noalias() = along.transpose() * g;
      slopes += along.cols();
    }
  }
  // Keeps the observable directions and returns the others. `slopes` has a column per sample;
  // `blur` is the clock's information from a force of pure noise.
  MatX keepObservable(const MatX& slopes, double correlation_length, double blur) {
    if (directions.cols() == 0) return directions;
    const MatX normal = slopes * slopes.transpose();
    const SymmetricEigen eigen(normal);
    // The deviation is the noise times sqrt(correlation_length / eigenvalue).
    const double least = std::max(correlation_length / (kJointMaxDeviation * kJointMaxDeviation),
                                  1e-9 * eigen.values[directions.cols() - 1]);
    const MatX all = directions * eigen.vectors;
    std::vector<Eigen::Index> observable, lost;
    for (Eigen::Index k = 0; k < all.cols(); ++k)
      (eigen.values[k] > std::max(least, blur * all(9, k) * all(9, k)) ? observable : lost)
          .push_back(k);
    directions = all(Eigen::all, observable);
    return all(Eigen::all, lost);
  }
};

std::string directionInWords(const JointVector& direction) {
  std::string words;
  const auto add = [&](const std::string& what) {
    words += (words.empty() ? "" : " with ") + what;
  };
  const Vec3 tip = direction.segment<3>(6);
  if (tip.squaredNorm() > kJointNamed) {
    Vec3 axis = tip.normalized();
    Eigen::Index largest;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) axis = -axis;
    for (double& each : axis)
      if (std::abs(each) < 5e-3) each = 0;
    char text[80];
    std::snprintf(text, sizeof text, "the tip along (%.2g, %.2g, %.2g) of the probe", axis[0],
                  axis[1], axis[2]);
    add(text);
  }
  if (direction[9] * direction[9] > kJointNamed) add("the clock");
  if (direction.head<3>().squaredNorm() > kJointNamed) add("the path's turn");
  if (direction.segment<3>(3).squaredNorm() > kJointNamed) add("the path's shift");
  return words;
}

void requireSolved(const std::string& cause) {
  if (!cause.empty()) throw Error("pose, tip and clock cannot be refined together: " + cause);
}

} // namespace

JointFit fitJointly(const SurfaceTarget& target, const std::vector<PathSample>& path,
                    const std::vector<bool>& inliers, const Pose& mesh_from_path,
                    const JointOptions& options) {
  Joint joint{target, path, options.compliance, localMotions(path)};
  for (std::size_t i = 0; i < inliers.size(); ++i)
    if (inliers[i]) joint.inlier_samples.push_back(i);
  const auto n = static_cast<double>(joint.inlier_samples.size());
  if (path.size() != inliers.size() || n == 0)
    throw std::invalid_argument("fitJointly: no sample counts");
  std::vector<Vec3> points; // inliers
  FitOptions plain;
  double speeds = 0, blurs = 0, roughness = 0;
  for (const std::size_t i : joint.inlier_samples) {
    points.push_back(path[i].position);
    if (options.compliance > 0) plain.indentations.push_back(options.compliance * path[i].force);
    speeds += joint.motions[i].velocity.squaredNorm() / n;
    blurs += joint.motions[i].rate_variance;
    roughness += std::pow(path[i].force - joint.motions[i].force, 2) / n;
  }
  if (speeds > 0) joint.speed = std::sqrt(speeds);
  const double blur =
      kJointMinInformation * blurs * roughness * std::pow(options.compliance / joint.speed, 2);

  // Search directions: requested and observable by the surface.
  const PathFit alone = fitPath(target, points, mesh_from_path, plain);
  const UnobservableMotions free = unobservableMotions(
      target, points, alone, alone.rms, options.correlation_length, plain.indentations);
  JointMatrix fixed_directions = JointMatrix::Zero();
  fixed_directions.topLeftCorner<6, 6>() = free.basis * free.basis.transpose();
  if (!options.tip) fixed_directions.block<3, 3>(6, 6).setIdentity();
  // A wrong tip would act as noise that hides the clock.
  bool clock_fixed = options.tip && options.clock;

  JointFit fit;
  joint.here.pose = mesh_from_path;
  joint.surface_residuals = alone.residuals; // start faces of the closest-point queries
  joint.go(nullptr);
  LeastSquares task;
  task.residuals = static_cast<int>(points.size());
  task.settled = kJointSettled * kJointSettled * options.correlation_length / n;
  task.evaluate = [&](const double* gone, double* residuals, double* slopes) {
    joint.evaluate(gone, residuals, slopes);
  };
  VecX distances(points.size());
  MatX lost;
  std::vector<double> gone, covariance;
  for (;;) {
    fixed_directions(9, 9) = options.clock && speeds > 0 && !clock_fixed ? 0 : 1;
    const SymmetricEigen open(fixed_directions);
    joint.directions = open.vectors.leftCols((open.values.array() < 0.5).count());
    gone.assign(kJointValues, 0);
    MatX slopes(joint.directions.cols(), distances.size());
    joint.evaluate(gone.data(), distances.data(), slopes.data());
    lost = joint.keepObservable(slopes, options.correlation_length, blur);
    gone.resize(static_cast<std::size_t>(joint.directions.cols()));
    task.values = static_cast<int>(gone.size());
    task.max_steps = kJointMostSteps - fit.iterations;
    if (fit.converged || task.max_steps <= 0) break;
    LeastSquaresSteps steps;
    requireSolved(solverLibrary().solve(task, gone, steps));
    joint.go(gone.data());
    fit.iterations += std::max(steps.tried, 1);
    // The observable directions depend on the pose, which is final if no step leaves it.
    fit.converged = steps.settled && !clock_fixed && (lost.cols() == 0 || steps.taken == 0);
    clock_fixed = false;
  }
  requireSolved(solverLibrary().covariance(task, gone, covariance));

  JointVector units; // units of the parameters
  units << Vec3::Constant(1 / joint.scale.radius), Vec3::Ones(), Vec3::Ones(), 1 / joint.speed;
  const MatX spread = units.asDiagonal() * joint.directions;
  fit.covariance = distances.squaredNorm() / std::max(n - kJointValues, 1.0) *
                   options.correlation_length * spread *
                   Eigen::Map<const MatX>(covariance.data(), task.values, task.values) *
                   spread.transpose();
  for (const UnobservableMotion& motion : free.named)
    fit.unobservable_parameters.push_back(inWords(motion));
  for (const JointVector each : lost.colwise())
    fit.unobservable_parameters.push_back("free to move " + directionInWords(each));
  const VecX observable =
      joint.directions.rowwise().squaredNorm(); // observable part of each parameter
  if (observable.segment<3>(6).sum() > 2.5)
    fit.tip_deviation = std::sqrt(fit.covariance.block<3, 3>(6, 6).trace() / 3);
  if (observable[9] > 0.5) fit.clock_deviation = std::sqrt(fit.covariance(9, 9));
  fit.middle = joint.scale.centre;
  fit.mesh_from_path = joint.here.pose;
  fit.tip = joint.here.tip;
  fit.clock = joint.here.clock;
  fit.rms = distances.norm() / std::sqrt(n);
  for (std::size_t i = 0; i < path.size(); ++i) fit.path.push_back(joint.felt(i));
  return fit;
}

namespace {

// Refines one pose; `found` gets the result except the alternative poses.
JointFit refineHere(const SurfaceTarget& target, JointOptions options,
                    const RegistrationOptions& registering, const std::vector<PathSample>& path,
                    Registration& found) {
  const double noise = registering.noise;
  options.correlation_length = 1; // not that of a wrong calibration
  const Pose start = found.mesh_from_path;
  JointFit joint;
  std::vector<Vec3> points(path.size());
  PathFit fit;
  fit.weights.resize(path.size());
  fit.residuals.resize(path.size());
  // A better calibration changes the inliers and the correlation of the errors.
  for (int round = 0; round < kJointRecounts; ++round) {
    joint = fitJointly(target, path, found.inliers, start, options);
    fit.mesh_from_path = joint.mesh_from_path;
    fit.rms = joint.rms;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < path.size(); ++i) {
      points[i] = joint.path[i].position;
      fit.residuals[i] =
          target.residual(joint.mesh_from_path * points[i], fit.residuals[i].foot.face);
      fit.residuals[i].distance += options.compliance * path[i].force;
      fit.weights[i] = found.inliers[i] ? 1 : 0;
      sizes.push_back(std::abs(fit.residuals[i].distance));
    }
    const double most = inlierThreshold(sizes, minNoise(points, noise));
    std::vector<bool> inliers;
    for (const double size : sizes) inliers.push_back(size <= most);
    if (round + 1 == kJointRecounts) break;
    const double correlation_length = fitNoiseModel(points, fit, noise).correlation_length;
    if (inliers == found.inliers &&
        std::abs(std::log(correlation_length / options.correlation_length)) < 0.1)
      break;
    found.inliers = std::move(inliers);
    options.correlation_length = correlation_length;
  }
  found.mesh_from_path = joint.mesh_from_path;
  found.covariance = joint.covariance.topLeftCorner<6, 6>();
  found.middle = joint.middle;
  found.rms = joint.rms;
  found.correlation_length = options.correlation_length;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!found.inliers[i]) continue;
    sum += std::abs(fit.residuals[i].distance);
    ++count;
  }
  found.mean_distance = sum / count;
  found.noise = std::max(joint.rms, minNoise(points, noise));
  found.converged =
      joint.converged &&
      isConsistentWithNoise(joint.rms, count / static_cast<double>(path.size()), noise,
                            std::hypot(minNoise(points, noise), registering.roughness),
                            registering.outliers);
  if (noise > 0)
    found.roughness =
        std::sqrt(std::max(0., joint.rms * joint.rms - std::pow(minNoise(points, noise), 2)));
  found.residuals = std::move(fit.residuals);
  return joint;
}

} // namespace

JointFit refine(const SurfaceTarget& target, const JointOptions& options,
                RegistrationOptions registering, std::vector<PathSample>& path, Registration& found,
                Progress& progress) {
  registering.force.clear();
  registering.search = false;
  JointFit joint;
  for (int round = 0;; ++round) {
    joint = refineHere(target, options, registering, path, found);
    if (!registering.alternatives) break;
    // Searches alternative poses again with the corrected tip and clock.
    std::vector<Vec3> points;
    registering.indentations.clear();
    for (const PathSample& sample : joint.path) {
      points.push_back(sample.position);
      registering.indentations.push_back(options.compliance * sample.force);
    }
    Registration judged = registerPath(target, points, joint.mesh_from_path, registering, progress);
    found.alternatives = std::move(judged.alternatives);
    if (isSamePose(joint.mesh_from_path, judged.mesh_from_path, points)) break;
    if (round == kJointPlaces) { // each leads to the other
      found.converged = false;
      break;
    }
    found.mesh_from_path = judged.mesh_from_path; // fits better, perhaps with another tip
    found.inliers = std::move(judged.inliers);
  }
  path = joint.path;
  return joint;
}

} // namespace patina
