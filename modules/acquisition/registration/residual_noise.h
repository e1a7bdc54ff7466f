// Noise model of the residuals (A28). Errors of camera poses are correlated in time, so several
// consecutive samples carry the information of one independent sample.
#pragma once

#include "acquisition/registration/compliance_fit.h"

namespace patina {

struct ResidualNoiseModel {
  double deviation = 0; // a point's distance error, corrected for the fit's degrees of freedom [m]
  double correlation_length = 1; // integrated autocorrelation time: points per independent point
  // Normal equations N of the inliers, in PoseScaling's lengths and, if fitted, the depth at each
  // scan's rms force, and covariance M of their right side: the sandwich estimator (Huber 1967;
  // White 1980) is inv(N) M inv(N).
  Eigen::MatrixXd normal, score_covariance;

  // Returns the covariance of pose and depths orthogonal to `free`, and zero along it.
  Eigen::MatrixXd wholeCovariance(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const;
  // The pose's part of it.
  Mat6 covariance(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const;
};

// Estimates the model from a fit's residuals by restricted maximum likelihood (REML, Patterson &
// Thompson 1971) over correlation ranges. `noise` [m] is a lower limit, as stated by the path.
// `forces` is empty unless compliances were fitted.
ResidualNoiseModel fitNoiseModel(const std::vector<Vec3>& points, const PathFit& fit, double noise,
                                 const ScanForces& forces = {});

} // namespace patina
