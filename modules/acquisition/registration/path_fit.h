// Least-squares fit of a path's pose to a surface by its point-to-surface distances (A10):
// Gauss-Newton with the distance's gradient, damped if a step fails, restricted to observable
// motions.
#pragma once

#include <vector>

#include "acquisition/registration/surface_target.h"

namespace patina {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Smallest eigenvalue of the normal equations over the largest for which a step is taken.
constexpr double kRankTolerance = 1e-4;

// Scales a small motion to lengths [m]: rotation about `centre` times `radius`, translation.
struct PoseScaling {
  Vec3 centre = Vec3::Zero(); // centre of the points at the present pose
  double radius = 1;          // rms distance of the points from it

  Pose motion(const Vec6& lengths) const;
  Vec6 gradient(const Vec3& at, const Vec3& direction) const; // derivative of a distance
};
// Limits a step to half a radian and a quarter of the mesh's extent [m], where it counts as small.
void limit(Vec6& step, const PoseScaling& scale, double extent);
PoseScaling scaleOf(const std::vector<Vec3>& points, const Pose& mesh_from_path);

struct PathFit {
  Pose mesh_from_path = Pose::Identity();
  std::vector<SurfaceResidual> residuals; // one per point, at that pose
  std::vector<double> weights;            // in [0, 1]; 0: outlier
  double rms = 0;                         // rms distance of the inliers [m]
  Mat6 normal = Mat6::Zero(); // normal equations of the inliers, in PoseScaling's lengths
  int iterations = 0;
  std::size_t evaluations = 0;                    // number of distance queries
  double last_rotation = 0, last_translation = 0; // last step [rad, m]
  // True if residuals and pose settled, the pose to a hundredth of its standard deviation.
  bool converged = false;
};

struct FitOptions {
  int iterations = 60;
  // Indentation of each point [m]; empty: none. The target must have sides.
  std::vector<double> indentations;
  // Points off by several times `noise` get small, finally zero weights; 0: equal weights.
  double noise = 0; // [m]
};

// Ignores points that are not finite. Throws std::invalid_argument without any point.
PathFit fitPath(const SurfaceTarget& target, const std::vector<Vec3>& points, const Pose& start,
                const FitOptions& options = {});

// Returns the inlier threshold [m]: three standard deviations, estimated from the better half of
// the residuals and at least `noise`. At least one size must be given.
double inlierThreshold(std::vector<double> sizes, double noise);

} // namespace patina
