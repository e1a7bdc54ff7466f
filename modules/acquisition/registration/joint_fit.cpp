#include "acquisition/registration/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "acquisition/registration/free_motions.h"
#include "acquisition/registration/path_course.h"
#include "core/decompose.h"

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
  const std::vector<bool>& counts;
  double compliance;
  std::vector<Course> courses;
  double speed = 0; // [m/s], that makes a length of the clock

  // Where the probe was when it felt what it felt at the sample's time.
  PathSample felt(std::size_t i, const Values& at) const {
    const Course& course = courses[i];
    PathSample sample = path[i];
    const Vec3 turn = at.clock * course.spin;
    if (const double angle = turn.norm(); angle > 0)
      sample.orientation = Eigen::AngleAxisd(angle, turn / angle) * sample.orientation;
    sample.position +=
        at.clock * (course.speed + 0.5 * at.clock * course.bend) + sample.orientation * at.tip;
    return sample;
  }
  // The places stay as they were measured, and what was felt there is looked up at its own time:
  // the surface tells nothing of the clock but by how far it yields, and a force is less noisy than
  // the path's speed.
  Vec3 place(std::size_t i, const Values& at) const {
    return path[i].position + path[i].orientation * at.tip;
  }
  double pressed(std::size_t i, const Values& at) const {
    return compliance > 0 ? compliance * forceBefore(path, courses, i, at.clock).force : 0;
  }
  double missAt(std::size_t i, const Values& at, Miss& miss) const {
    miss = target.miss(at.pose * place(i, at), miss.foot.face);
    return miss.distance + pressed(i, at);
  }
  double squares(const Values& at, std::vector<Miss>& misses) const {
    double sum = 0;
    for (std::size_t i = 0; i < path.size(); ++i)
      if (counts[i]) {
        const double r = missAt(i, at, misses[i]);
        sum += r * r;
      }
    return sum;
  }
  JointVector gradient(std::size_t i, const Values& at, const Miss& miss,
                       const MotionScale& scale) const {
    const Vec3 along = at.pose.linear().transpose() * miss.direction; // in the path's frame
    JointVector g;
    g << scale.gradient(at.pose * place(i, at), miss.direction),
        path[i].orientation.conjugate() * along,
        compliance > 0 ? -compliance * forceBefore(path, courses, i, at.clock).rise / speed : 0;
    return g;
  }
  Values moved(const Values& at, const JointVector& step, const MotionScale& scale) const {
    return {scale.motion(step.head<6>()) * at.pose, at.tip + step.segment<3>(6),
            at.clock + step[9] / speed};
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

} // namespace

JointFit fitJointly(const SurfaceTarget& target, const std::vector<PathSample>& path,
                    const std::vector<bool>& counts, const Pose& mesh_from_path,
                    const JointOptions& options) {
  const auto n = std::count(counts.begin(), counts.end(), true);
  if (path.size() != counts.size() || n == 0)
    throw std::invalid_argument("fitJointly: no sample counts");
  Joint joint{target, path, counts, options.compliance, coursesOf(path)};
  std::vector<Vec3> points; // that count
  std::vector<double> pressed;
  double speeds = 0, blurs = 0, roughness = 0;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (counts[i]) {
      points.push_back(path[i].position);
      pressed.push_back(options.compliance * path[i].force);
      speeds += joint.courses[i].speed.squaredNorm();
      blurs += joint.courses[i].blur;
      roughness += std::pow(path[i].force - joint.courses[i].force, 2) / static_cast<double>(n);
    }
  joint.speed = std::sqrt(speeds / static_cast<double>(n));

  // Directions that are not asked for, or that the surface does not see.
  std::vector<JointVector> shut;
  FitOptions plain;
  if (options.compliance > 0) plain.pressed = pressed;
  const PathFit alone = fitPath(target, points, mesh_from_path, plain);
  const FreeMotions free =
      freeMotions(target, points, alone, alone.rms, options.together, plain.pressed);
  for (Eigen::Index k = 0; k < free.basis.cols(); ++k) {
    shut.push_back(JointVector::Zero());
    shut.back().head<6>() = free.basis.col(k);
  }
  for (int k = 6; k < kJointValues; ++k)
    if (k < 9 ? !options.tip : !options.clock || !(joint.speed > 0))
      shut.push_back(JointVector::Unit(k));
  if (!(joint.speed > 0)) joint.speed = 1;

  JointFit fit;
  for (const FreeMotion& motion : free.named) fit.frozen.push_back(inWords(motion));
  Values at{mesh_from_path};
  std::vector<Miss> misses(path.size());
  double sum = joint.squares(at, misses), damping = 0;
  // What slopes of the force would say of the clock if it were all noise.
  const double blur =
      kJointClear * blurs * roughness * std::pow(options.compliance / joint.speed, 2);
  // A tip that is off would pass for noise in which the clock is lost.
  bool clock_waits = options.tip && options.clock;
  while (fit.iterations < kJointMostSteps && !fit.converged) {
    ++fit.iterations;
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < path.size(); ++i)
      if (counts[i]) places.push_back(joint.place(i, at));
    const MotionScale scale = scaleOf(places, at.pose);
    JointMatrix normal = JointMatrix::Zero();
    JointVector right = JointVector::Zero();
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (!counts[i]) continue;
      JointVector g = joint.gradient(i, at, misses[i], scale);
      if (clock_waits) g[9] = 0;
      for (const JointVector& each : shut) g -= each * each.dot(g);
      const double r = misses[i].distance + joint.pressed(i, at);
      normal += g * g.transpose();
      right -= r * g;
    }
    const double worth = options.together;
    const SymmetricEigen eigen(normal);
    const double largest = std::max(eigen.values[kJointValues - 1], 1e-300);
    // Its deviation, noise sqrt(worth / value), against kJointFar times the noise.
    const double least = std::max(worth / (kJointFar * kJointFar), 1e-9 * largest);
    const double noise = std::sqrt(sum / std::max(static_cast<double>(n) - kJointValues, 1.0));
    const auto told = [&](int k) {
      const double of_clock = eigen.vectors(9, k);
      return eigen.values[k] > std::max(least, blur * of_clock * of_clock);
    };
    for (;;) {
      JointVector step = JointVector::Zero();
      double deviations = 0; // of the step, in those that are stated
      for (int k = 0; k < kJointValues; ++k) {
        const double value = eigen.values[k];
        if (!told(k)) continue;
        const double along = eigen.vectors.col(k).dot(right) / (value + damping * largest);
        step += along * eigen.vectors.col(k);
        deviations = std::max(deviations,
                              std::abs(along) * std::sqrt(value / worth) / std::max(noise, 1e-12));
      }
      const Values next = joint.moved(at, step, scale);
      std::vector<Miss> there = misses;
      const double after = joint.squares(next, there);
      const bool still = deviations < kJointSettled;
      if (after <= sum || still) {
        fit.converged = still;
        if (after <= sum) {
          at = next;
          misses = std::move(there);
          sum = after;
        }
        damping = damping < 1e-6 ? 0 : damping / 10;
        break;
      }
      damping = std::max(1e-4, damping * 10);
    }
    if (clock_waits && fit.converged) {
      clock_waits = fit.converged = false;
      continue;
    }
    if (!fit.converged && fit.iterations < kJointMostSteps) continue;
    // What is left unknown, in the values' own units.
    double tip_frozen = 0, clock_frozen = 0; // squares of what is not told
    JointVector units;
    units << Vec3::Constant(1 / scale.radius), Vec3::Ones(), Vec3::Ones(), 1 / joint.speed;
    for (int k = 0; k < kJointValues; ++k) {
      const JointVector direction = eigen.vectors.col(k);
      if (told(k)) {
        const JointVector unit = units.cwiseProduct(direction);
        fit.covariance += noise * noise * worth / eigen.values[k] * unit * unit.transpose();
        continue;
      }
      tip_frozen += direction.segment<3>(6).squaredNorm();
      clock_frozen += direction[9] * direction[9];
      double of_shut = 0; // of which nothing more is said
      for (const JointVector& each : shut) of_shut += std::pow(each.dot(direction), 2);
      if (of_shut < 0.5) fit.frozen.push_back("free to move " + directionInWords(direction));
    }
    if (tip_frozen < 0.5)
      fit.tip_deviation = std::sqrt(fit.covariance.block<3, 3>(6, 6).trace() / 3);
    if (clock_frozen < 0.5) fit.clock_deviation = std::sqrt(fit.covariance(9, 9));
    fit.middle = scale.centre;
  }
  fit.mesh_from_path = at.pose;
  fit.tip = at.tip;
  fit.clock = at.clock;
  fit.rms = std::sqrt(sum / static_cast<double>(n));
  for (std::size_t i = 0; i < path.size(); ++i) fit.path.push_back(joint.felt(i, at));
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
