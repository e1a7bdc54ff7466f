// Pivot calibration: finds a probe's tip from poses in which it rotates about a fixed point (A05).
#pragma once

#include <optional>

#include "acquisition/values/scan_samples.h"

namespace patina {

struct PivotFit {
  Vec3 tip = Vec3::Zero();                              // in the probe's frame [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(); // covariance of the tip [m^2]
  Vec3 point = Vec3::Zero();                            // fixed point in the camera's frame [m]
  double rms = 0;           // distance of the tips used from the point [m]
  std::size_t rejected = 0; // outliers
};

// Robust fit with Tukey's biweight (Beaton & Tukey 1974); up to a third of the poses may be wrong.
// Poses are weighted by their own deviations, of which only the ratios matter. Returns nullopt for
// fewer than ten poses, or if they rotate too little about two axes.
std::optional<PivotFit> fitPivot(const std::vector<CameraPose>& poses);

} // namespace patina
