// Joint fit of pose, tip and clock offset, so that calibration errors do not bias the pose (A10).
#pragma once

#include <optional>
#include <string>

#include "acquisition/registration/register_path.h"
#include "acquisition/registration/residual_noise.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// Similarity fit: scale of the path for which it fits a mesh best.
struct SimilarityFit {
  Pose mesh_from_path = Pose::Identity(); // pose of the path scaled about its points' center
  double scale = 1;                       // scale of the path
  double deviation = 0;                   // standard deviation of the scale
  double rms = 0;                         // inliers [m]
  std::vector<SurfaceResidual> residuals; // all points
  bool converged = false;
};

// Gauss-Newton over pose and scale. Starts with the inliers of a fit without scale, which may be
// the few that another size leaves on the surface, and selects them again by inlierThreshold(). The
// deviation follows from this fit's own residuals (fitNoiseModel() with the lower limit `noise`).
// `indentations`: see FitOptions.
SimilarityFit fitSimilarity(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& mesh_from_path, const std::vector<bool>& inliers,
                            const std::vector<double>& indentations, double noise);

struct JointOptions {
  bool tip = true, clock = true; // parameters estimated besides the pose
  double compliance = 0;         // compliance of the surface [m/N]
  double correlation_length = 1; // correlated samples per independent one (ResidualNoiseModel)
};

constexpr int kJointValues = 10;
using JointVector = Eigen::Matrix<double, kJointValues, 1>;
using JointMatrix = Eigen::Matrix<double, kJointValues, kJointValues>;

struct JointFit {
  Pose mesh_from_path = Pose::Identity();
  Vec3 tip = Vec3::Zero(); // correction of the tip in the probe's frame [m]
  double clock = 0;        // the force at time t belongs to the position at t + clock [s]
  // Covariance of a small rotation about the path's center [rad], its translation [m], both in the
  // mesh's frame, tip and clock; unobservable directions add nothing. Correlated errors of
  // neighbouring samples are accounted for.
  JointMatrix covariance = JointMatrix::Zero();
  Vec3 middle = Vec3::Zero(); // in the mesh's frame [m]
  // Deviations of the tip (rms of its axes) [m] and the clock [s]; absent if not observable.
  std::optional<double> tip_deviation, clock_deviation;
  // Descriptions of the unobservable directions, which keep their values.
  std::vector<std::string> unobservable_parameters;
  std::vector<PathSample> path; // with the corrections
  double rms = 0;               // inliers [m]
  int iterations = 0;
  bool converged = false;
};

// Starts from a registration with the inliers `inliers`. The clock is observable only through the
// compliance; the rate of the force is that of local parabolas through about forty samples. A
// direction stays fixed if its predicted deviation, as a length over the path's extent, exceeds ten
// times that of the samples, or if it is an unobservable motion of the pose (unobservableMotions).
// Throws std::invalid_argument if the numbers of samples and inlier flags differ, or without
// inliers, and Error if Ceres cannot be loaded.
JointFit fitJointly(const SurfaceTarget& target, const std::vector<PathSample>& path,
                    const std::vector<bool>& inliers, const Pose& mesh_from_path,
                    const JointOptions& options = {});

// The same for a registered path; updates the path and its registration. Inliers are selected
// again, convergence is tested on the final residuals, and alternative poses are searched for the
// refined path if `registering` requests them. Throws Cancelled.
JointFit refine(const SurfaceTarget& target, const JointOptions& options,
                RegistrationOptions registering, std::vector<PathSample>& path, Registration& found,
                Progress& progress);

} // namespace patina
