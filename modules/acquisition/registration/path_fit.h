// Least squares of a path's distances from a surface over its pose (A10): Gauss-Newton with the
// distance's own gradient, damped where that does not help, and blind to motions that the surface
// does not see.
#pragma once

#include <vector>

#include "acquisition/registration/surface_target.h"

namespace patina {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Of the largest eigenvalue of the normal equations: motions below it are not taken.
constexpr double kBlind = 1e-4;

// A small motion as six lengths: a turn about `centre` times `radius`, then a shift [m].
struct MotionScale {
  Vec3 centre = Vec3::Zero(); // of the points where they lie now
  double radius = 1;          // rms distance of the points from it

  Pose motion(const Vec6& lengths) const;
  Vec6 gradient(const Vec3& at, const Vec3& direction) const; // of a distance at a point
};
// To half a radian and a quarter of the mesh's extent [m]: what is farther is no small motion.
void limit(Vec6& step, const MotionScale& scale, double extent);
MotionScale scaleOf(const std::vector<Vec3>& points, const Pose& mesh_from_path);

struct PathFit {
  Pose mesh_from_path = Pose::Identity();
  std::vector<Miss> misses;    // of all points, at that pose
  std::vector<double> weights; // in [0, 1]; 0 = it does not count
  double rms = 0;              // of what counts [m]
  Mat6 normal = Mat6::Zero();  // of what counts, in MotionScale's lengths
  int iterations = 0;
  std::size_t evaluations = 0;          // of a point's distance
  double last_turn = 0, last_shift = 0; // of the last step [rad, m]
  // Neither residual nor pose moved any more, the pose by less than a hundredth of what the points
  // tell it to.
  bool converged = false;
};

struct FitOptions {
  int iterations = 60;
  // How far each point was pressed below where an unyielding surface would hold it [m]; empty: not
  // at all. Asks for a target with sides.
  std::vector<double> pressed;
  // A point off by several times `noise` hardly counts, and in the end not at all; 0: all count.
  double noise = 0; // [m]
};

// Points that are not finite do not count. One point or more; throws std::invalid_argument
// otherwise.
PathFit fitPath(const SurfaceTarget& target, const std::vector<Vec3>& points, const Pose& start,
                const FitOptions& options = {});

// How far off a point may be and count [m], by sizes of what is finite: three deviations, those of
// `noise` or of the better half where that is more. One size or more.
double reachOfCounting(std::vector<double> sizes, double noise);

} // namespace patina
