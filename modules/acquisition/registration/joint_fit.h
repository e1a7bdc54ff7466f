// Registration, the tip's place in the probe and the clocks' offset, refined together (A10): what
// of a scan's distances a wrong calibration explains is not left to the pose.
#pragma once

#include <optional>
#include <string>

#include "acquisition/registration/register_path.h"
#include "acquisition/scan_samples.h"

namespace patina {

struct JointOptions {
  bool tip = true, clock = true; // refined beside the pose
  double compliance = 0;         // how far the surface yields to a newton [m/N]
  double together = 1;           // so many samples in a row are worth one (ErrorLaw)
};

constexpr int kJointValues = 10;
using JointVector = Eigen::Matrix<double, kJointValues, 1>;
using JointMatrix = Eigen::Matrix<double, kJointValues, kJointValues>;

struct JointFit {
  Pose mesh_from_path = Pose::Identity();
  Vec3 tip = Vec3::Zero(); // added to the tip, in the probe's frame [m]
  // What the probe felt at t was at the place of the path's t + clock [s].
  double clock = 0;
  // Of a small turn about the path's middle [rad], its shift [m], both in the mesh's frame, tip and
  // clock; what is frozen adds nothing. Errors that neighbouring samples share count once.
  JointMatrix covariance = JointMatrix::Zero();
  Vec3 middle = Vec3::Zero(); // [m], in the mesh's frame
  // One deviation, rms of the tip's axes [m], of the clock [s]; none where not all of it is told.
  std::optional<double> tip_deviation, clock_deviation;
  // In words, each a direction that the distances do not tell: it stays where it was.
  std::vector<std::string> frozen;
  std::vector<PathSample> path; // with the corrections
  double rms = 0;               // of what counts [m]
  int iterations = 0;
  bool converged = false;
};

// From a registration of the samples, of which `counts` says what counts. Of the clock the surface
// tells only by how far it yields: the force's rise is that of parabolas through some forty
// samples. A direction is frozen where its predicted deviation, as a length over the path's extent,
// is above ten times that of the samples; so is what the surface does not see of the pose
// (freeMotions). Throws std::invalid_argument where the numbers of samples and counts differ, or
// none counts, and Error where Ceres cannot be loaded.
JointFit fitJointly(const SurfaceTarget& target, const std::vector<PathSample>& path,
                    const std::vector<bool>& counts, const Pose& mesh_from_path,
                    const JointOptions& options = {});

// The same from a registration of the path, which with its samples becomes what the joint fit says:
// what counts is chosen anew, whether it converged is judged by the distances that are left, and
// where `registering` asks for other places, they are those of the path that was found. Throws
// Cancelled.
JointFit refine(const SurfaceTarget& target, const JointOptions& options,
                RegistrationOptions registering, std::vector<PathSample>& path, Registration& found,
                Progress& progress);

} // namespace patina
