#include "acquisition/registration/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "acquisition/registration/free_motions.h"
#include "acquisition/registration/path_course.h"
#include "acquisition/solver_library.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kJointFar = 10; // times the noise: as far as a direction must be told
constexpr int kJointMostSteps = 30, kJointRecounts = 5, kJointPlaces = 3;
constexpr double kJointSettled = 1e-2; // of the deviation: less is no step
constexpr double kJointClear = 10;     // times what the force's noise says of the clock: it is told
constexpr double kJointNamed = 0.15;   // of a frozen direction's square: less is not named

struct Values {
  Pose pose;
  Vec3 tip = Vec3::Zero();
  double clock = 0;
};

struct Joint {
  const SurfaceTarget& target;
  const std::vector<PathSample>& path;
  double compliance;
  std::vector<Course> courses;
  std::vector<std::size_t> counting{}; // samples
  double speed = 1;                    // [m/s], that makes a length of the clock
  Values here{};
  MotionScale scale{};
  // Orthonormal ways to go from here, as ten lengths. How far to go along each is what Ceres finds.
  Eigen::Matrix<double, kJointValues, Eigen::Dynamic> ways{};
  // Of the samples that count, and the lengths from here that they were looked up after.
  std::vector<Miss> misses{};
  JointVector missed_at = JointVector::Constant(std::nan(""));

  // Where the probe was when it felt what it felt at the sample's time.
  PathSample felt(std::size_t i) const {
    const Course& course = courses[i];
    PathSample sample = path[i];
    const Vec3 turn = here.clock * course.spin;
    if (const double angle = turn.norm(); angle > 0)
      sample.orientation = Eigen::AngleAxisd(angle, turn / angle) * sample.orientation;
    sample.position += here.clock * (course.speed + 0.5 * here.clock * course.bend) +
                       sample.orientation * here.tip;
    return sample;
  }
  // The places stay as they were measured, and what was felt there is looked up at its own time:
  // the surface tells nothing of the clock but by how far it yields, and a force is less noisy than
  // the path's speed.
  Vec3 place(std::size_t i, const Vec3& tip) const {
    return path[i].position + path[i].orientation * tip;
  }
  Values after(const JointVector& lengths) const {
    return {scale.motion(lengths.head<6>()) * here.pose, here.tip + lengths.segment<3>(6),
            here.clock + lengths[9] / speed};
  }
  // So far along the ways, which are then counted from there.
  void go(const double* gone) {
    const JointVector lengths = ways * Eigen::Map<const VecX>(gone, ways.cols());
    here = after(lengths);
    missed_at -= lengths;
    std::vector<Vec3> places;
    for (const std::size_t i : counting) places.push_back(place(i, here.tip));
    scale = scaleOf(places, here.pose);
  }
  // Distances of the samples that count and, unless it is nullptr, how each grows along the ways.
  void evaluate(const double* gone, double* distances, double* slopes) {
    const JointVector lengths = ways * Eigen::Map<const VecX>(gone, ways.cols());
    const Values at = after(lengths);
    if (missed_at != lengths)
      for (std::size_t k = 0; k < counting.size(); ++k)
        misses[k] = target.miss(at.pose * place(counting[k], at.tip), misses[k].foot.face);
    missed_at = lengths;
    const MotionScale there{scale.centre + lengths.segment<3>(3), scale.radius};
    // Where a turn's vector w grows by dw, a small turn by J dw follows it. J, the left Jacobian of
    // SO(3), is the mean of the turns by 0 to w: by Simpson's rule, to 1e-6 up to 0.25 rad.
    const Vec6 half = lengths.head<6>() / 2;
    auto along = ways;
    along.topRows<3>() += (4 * scale.motion(half).linear() + scale.motion(2 * half).linear() -
                           5 * Eigen::Matrix3d::Identity()) /
                          6 * ways.topRows<3>();
    for (std::size_t k = 0; k < counting.size(); ++k) {
      const std::size_t i = counting[k];
      SmoothForce pressed;
      if (compliance > 0) pressed = forceBefore(path, courses, i, at.clock);
      distances[k] = misses[k].distance + compliance * pressed.force;
      if (!slopes) continue;
      JointVector g;
      g << there.gradient(at.pose * place(i, at.tip), misses[k].direction),
          path[i].orientation.conjugate() * (at.pose.linear().transpose() * misses[k].direction),
          -compliance * pressed.rise / speed;
      Eigen::Map<VecX>(slopes, along.cols()).noalias() = along.transpose() * g;
      slopes += along.cols();
    }
  }
  // Leaves those ways that the distances tell, and returns the others. Slopes: a column a sample;
  // `blur`: what slopes of the force would say of the clock if it were all noise.
  MatX keepTold(const MatX& slopes, double together, double blur) {
    if (ways.cols() == 0) return ways;
    const MatX normal = slopes * slopes.transpose();
    const SymmetricEigen eigen(normal);
    // Its deviation, noise sqrt(together / value), against kJointFar times the noise.
    const double least =
        std::max(together / (kJointFar * kJointFar), 1e-9 * eigen.values[ways.cols() - 1]);
    const MatX all = ways * eigen.vectors;
    std::vector<Eigen::Index> told, lost;
    for (Eigen::Index k = 0; k < all.cols(); ++k)
      (eigen.values[k] > std::max(least, blur * all(9, k) * all(9, k)) ? told : lost).push_back(k);
    ways = all(Eigen::all, told);
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
                    const std::vector<bool>& counts, const Pose& mesh_from_path,
                    const JointOptions& options) {
  Joint joint{target, path, options.compliance, coursesOf(path)};
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i]) joint.counting.push_back(i);
  const auto n = static_cast<double>(joint.counting.size());
  if (path.size() != counts.size() || n == 0)
    throw std::invalid_argument("fitJointly: no sample counts");
  std::vector<Vec3> points; // that count
  FitOptions plain;
  double speeds = 0, blurs = 0, roughness = 0;
  for (const std::size_t i : joint.counting) {
    points.push_back(path[i].position);
    if (options.compliance > 0) plain.pressed.push_back(options.compliance * path[i].force);
    speeds += joint.courses[i].speed.squaredNorm() / n;
    blurs += joint.courses[i].blur;
    roughness += std::pow(path[i].force - joint.courses[i].force, 2) / n;
  }
  if (speeds > 0) joint.speed = std::sqrt(speeds);
  const double blur =
      kJointClear * blurs * roughness * std::pow(options.compliance / joint.speed, 2);

  // Ways that are asked for and that the surface sees.
  const PathFit alone = fitPath(target, points, mesh_from_path, plain);
  const FreeMotions free =
      freeMotions(target, points, alone, alone.rms, options.together, plain.pressed);
  JointMatrix shut = JointMatrix::Zero();
  shut.topLeftCorner<6, 6>() = free.basis * free.basis.transpose();
  if (!options.tip) shut.block<3, 3>(6, 6).setIdentity();
  // A tip that is off would pass for noise in which the clock is lost.
  bool clock_waits = options.tip && options.clock;

  JointFit fit;
  joint.here.pose = mesh_from_path;
  joint.misses = alone.misses; // faces to look for the nearest one at first
  joint.go(nullptr);
  LeastSquares task;
  task.residuals = static_cast<int>(points.size());
  task.settled = kJointSettled * kJointSettled * options.together / n;
  task.evaluate = [&](const double* gone, double* residuals, double* slopes) {
    joint.evaluate(gone, residuals, slopes);
  };
  VecX distances(points.size());
  MatX lost;
  std::vector<double> gone, covariance;
  for (;;) {
    shut(9, 9) = options.clock && speeds > 0 && !clock_waits ? 0 : 1;
    const SymmetricEigen open(shut);
    joint.ways = open.vectors.leftCols((open.values.array() < 0.5).count());
    gone.assign(kJointValues, 0);
    MatX slopes(joint.ways.cols(), distances.size());
    joint.evaluate(gone.data(), distances.data(), slopes.data());
    lost = joint.keepTold(slopes, options.together, blur);
    gone.resize(static_cast<std::size_t>(joint.ways.cols()));
    task.values = static_cast<int>(gone.size());
    task.most_steps = kJointMostSteps - fit.iterations;
    if (fit.converged || task.most_steps <= 0) break;
    LeastSquaresSteps steps;
    requireSolved(solverLibrary().solve(task, gone, steps));
    joint.go(gone.data());
    fit.iterations += std::max(steps.tried, 1);
    // Which ways are told depends on the place: it is final where no step leads from it.
    fit.converged = steps.settled && !clock_waits && (lost.cols() == 0 || steps.taken == 0);
    clock_waits = false;
  }
  requireSolved(solverLibrary().covariance(task, gone, covariance));

  JointVector units; // the values' own
  units << Vec3::Constant(1 / joint.scale.radius), Vec3::Ones(), Vec3::Ones(), 1 / joint.speed;
  const MatX spread = units.asDiagonal() * joint.ways;
  fit.covariance = distances.squaredNorm() / std::max(n - kJointValues, 1.0) * options.together *
                   spread * Eigen::Map<const MatX>(covariance.data(), task.values, task.values) *
                   spread.transpose();
  for (const FreeMotion& motion : free.named) fit.frozen.push_back(inWords(motion));
  for (const JointVector each : lost.colwise())
    fit.frozen.push_back("free to move " + directionInWords(each));
  const VecX told = joint.ways.rowwise().squaredNorm(); // of each value, how much of it
  if (told.segment<3>(6).sum() > 2.5)
    fit.tip_deviation = std::sqrt(fit.covariance.block<3, 3>(6, 6).trace() / 3);
  if (told[9] > 0.5) fit.clock_deviation = std::sqrt(fit.covariance(9, 9));
  fit.middle = joint.scale.centre;
  fit.mesh_from_path = joint.here.pose;
  fit.tip = joint.here.tip;
  fit.clock = joint.here.clock;
  fit.rms = distances.norm() / std::sqrt(n);
  for (std::size_t i = 0; i < path.size(); ++i) fit.path.push_back(joint.felt(i));
  return fit;
}

namespace {

// From one place; `found` gets what the fit says but for its rivals.
JointFit refineHere(const SurfaceTarget& target, JointOptions options,
                    const RegistrationOptions& registering, const std::vector<PathSample>& path,
                    Registration& found) {
  const double noise = registering.noise;
  options.together = 1; // what it seems with a wrong calibration is another thing
  const Pose start = found.mesh_from_path;
  JointFit joint;
  std::vector<Vec3> points(path.size());
  PathFit fit;
  fit.weights.resize(path.size());
  fit.misses.resize(path.size());
  // What a wrong calibration had left out may count now, and errors go together otherwise.
  for (int round = 0; round < kJointRecounts; ++round) {
    joint = fitJointly(target, path, found.counts, start, options);
    fit.mesh_from_path = joint.mesh_from_path;
    fit.rms = joint.rms;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < path.size(); ++i) {
      points[i] = joint.path[i].position;
      fit.misses[i] = target.miss(joint.mesh_from_path * points[i], fit.misses[i].foot.face);
      fit.misses[i].distance += options.compliance * path[i].force;
      fit.weights[i] = found.counts[i] ? 1 : 0;
      sizes.push_back(std::abs(fit.misses[i].distance));
    }
    const double most = reachOfCounting(sizes, leastNoise(points, noise));
    std::vector<bool> counts;
    for (const double size : sizes) counts.push_back(size <= most);
    if (round + 1 == kJointRecounts) break;
    const double together = errorLaw(points, fit, noise).together;
    if (counts == found.counts && std::abs(std::log(together / options.together)) < 0.1) break;
    found.counts = std::move(counts);
    options.together = together;
  }
  found.mesh_from_path = joint.mesh_from_path;
  found.covariance = joint.covariance.topLeftCorner<6, 6>();
  found.middle = joint.middle;
  found.rms = joint.rms;
  found.together = options.together;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!found.counts[i]) continue;
    sum += std::abs(fit.misses[i].distance);
    ++count;
  }
  found.mean_distance = sum / count;
  found.noise = std::max(joint.rms, leastNoise(points, noise));
  found.converged =
      joint.converged && isExplained(joint.rms, count / static_cast<double>(path.size()), noise,
                                     std::hypot(leastNoise(points, noise), registering.roughness),
                                     registering.outliers);
  if (noise > 0)
    found.roughness =
        std::sqrt(std::max(0., joint.rms * joint.rms - std::pow(leastNoise(points, noise), 2)));
  found.misses = std::move(fit.misses);
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
    if (!registering.rivals) break;
    // Where else the path lies as well, now that its tip and clock are mended.
    std::vector<Vec3> points;
    registering.pressed.clear();
    for (const PathSample& sample : joint.path) {
      points.push_back(sample.position);
      registering.pressed.push_back(options.compliance * sample.force);
    }
    Registration judged = registerPath(target, points, joint.mesh_from_path, registering, progress);
    found.rivals = std::move(judged.rivals);
    if (isOnePlace(joint.mesh_from_path, judged.mesh_from_path, points)) break;
    if (round == kJointPlaces) { // each leads to the other
      found.converged = false;
      break;
    }
    found.mesh_from_path = judged.mesh_from_path; // lies better, perhaps with another tip
    found.counts = std::move(judged.counts);
  }
  path = joint.path;
  return joint;
}

} // namespace patina
