#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "acquisition/profile/height_profile.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kForceReach = 0.06; // half width of the local parabola of the force [s]

// Returns the second time derivative of the force at each sample of an interval [N/s^2].
std::vector<double> forceAccelerations(const std::vector<PathSample>& path,
                                       const ContactInterval& stretch) {
  std::vector<double> found;
  std::size_t begin = stretch.begin, end = stretch.begin;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    while (path[i].t - path[begin].t > kForceReach) ++begin;
    while (end < stretch.end && path[end].t - path[i].t <= kForceReach) ++end;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vec3 sums = Vec3::Zero();
    for (std::size_t k = begin; k < end; ++k) {
      const double t = (path[k].t - path[i].t) / kForceReach;
      const Vec3 row(1, t, t * t);
      squares += row * row.transpose();
      sums += path[k].force * row;
    }
    const bool enough = end - begin >= 3;
    found.push_back(
        enough ? 2 / (kForceReach * kForceReach) * SymmetricSolver(squares).solve(sums)[2] : 0);
  }
  return found;
}

// Tip acceleration [m/s^2] from the accelerometers, whose axes must span space.
class TipAcceleration {
 public:
  TipAcceleration(const ProbeModel& probe, const std::array<double, 4>& bias)
      : probe_(probe), bias_(bias) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    for (const AccelerometerAxis& axis : probe.axes)
      normal += axis.direction * axis.direction.transpose();
    bool spans = false;
    normal.computeInverseWithCheck(inverse_, spans, 1e-6);
    if (!spans) throw Error("the accelerometers' axes lie in one plane and measure no height");
  }

  Vec3 operator()(const ProbeSample& sample, const TipMotion& motion,
                  const Eigen::Quaterniond& orientation, const Vec3& gravity) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < probe_.axes.size(); ++k) {
      const Vec3& axis = probe_.axes[k].direction;
      const Vec3 arm = probe_.axes[k].position - probe_.tip;
      const Vec3 turning =
          motion.rate_of_rate.cross(arm) + motion.rate.cross(motion.rate.cross(arm));
      sum += axis * (sample.acceleration[k] - bias_[k] - axis.dot(turning));
    }
    return orientation * (inverse_ * sum) + gravity;
  }

 private:
  const ProbeModel& probe_;
  std::array<double, 4> bias_;
  Eigen::Matrix3d inverse_;
};

} // namespace

std::vector<TracedSample> profileSamples(const FilteredScan& scan, const ContactInterval& stretch,
                                         const std::vector<CameraPose>& poses,
                                         const ProbeModel& probe, const Vec3& gravity,
                                         const Plane& plane, double compliance) {
  const Vec3& normal = plane.normal;
  const TipAcceleration accelerationOf(probe, scan.bias);
  std::vector<TracedSample> trace;
  trace.reserve(stretch.end - stretch.begin);
  double along = 0;
  Vec3 direction = Vec3::Zero(); // direction of the last movement
  bool stood = false;
  const std::vector<double> force_change = forceAccelerations(scan.whole, stretch);
  std::size_t next = 0;
  while (next < poses.size() && !(poses[next].t > scan.whole[stretch.begin].t &&
                                  scan.track.verdicts[next] == PoseVerdict::used))
    ++next;
  auto reading = scan.samples.begin();
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const PathSample& point = scan.whole[i];
    while (reading != scan.samples.end() && reading->t != point.t) ++reading;
    if (reading == scan.samples.end())
      throw std::invalid_argument("traced: the path was not made from these samples");
    const TipMotion motion = motionAt(scan.track, point.t);
    const Vec3 velocity = motion.velocity - normal * normal.dot(motion.velocity);
    TracedSample sample;
    sample.t = point.t;
    sample.speed = velocity.norm();
    sample.is_stationary = sample.speed < kStationarySpeed;
    if (!trace.empty() && !sample.is_stationary)
      along += 0.5 * (sample.speed + trace.back().speed) * (sample.t - trace.back().t);
    sample.arc_length = along;
    const Vec3 heading = velocity / std::max(sample.speed, 1e-12);
    sample.tangential_acceleration = heading.dot(motion.acceleration);
    if (!sample.is_stationary) {
      if (stood && direction.squaredNorm() > 0)
        sample.direction_cosine = std::min(direction.dot(heading), 1.);
      direction = heading;
      stood = false;
    } else {
      stood = true;
    }
    sample.acceleration = normal.dot(accelerationOf(*reading, motion, point.orientation, gravity));
    sample.indentation = compliance * point.force;
    sample.indentation_acceleration = compliance * force_change[i - stretch.begin];
    if (next < poses.size() && poses[next].t <= point.t) {
      const CameraPose& pose = poses[next];
      const Vec3 lever = point.orientation * probe.tip;
      sample.height =
          normal.dot(pose.position + pose.orientation.normalized() * probe.tip - plane.point);
      sample.height_sigma =
          std::hypot(pose.sigma_position, pose.sigma_angle * lever.cross(normal).norm());
      do ++next;
      while (next < poses.size() && scan.track.verdicts[next] != PoseVerdict::used);
    }
    trace.push_back(sample);
  }
  return trace;
}

} // namespace patina
