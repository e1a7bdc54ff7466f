// Where a probe's tip is, from poses while it turns about a point that stands still (A05).
#pragma once

#include <optional>

#include "acquisition/scan_samples.h"

namespace patina {

struct PivotFit {
  Vec3 tip = Vec3::Zero();                              // in the probe's frame [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(); // of it [m^2]
  Vec3 point = Vec3::Zero();                            // where it stood, in the camera's frame [m]
  double rms = 0;           // of what was used, of the distance from the point [m]
  std::size_t rejected = 0; // poses that contradict the others
};

// Poses count by their own deviations, whose ratio matters and not their size: what the angle
// leaves open grows with the tip's distance. Robust against a third of wrong poses. Nothing with
// fewer than ten poses, or where they turn too little about two axes to tell the tip.
std::optional<PivotFit> fitPivot(const std::vector<CameraPose>& poses);

} // namespace patina
