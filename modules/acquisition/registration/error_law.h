// How the errors of a path's samples hang together (A28): a camera's poses err smoothly in time,
// so that many samples in a row are worth one.
#pragma once

#include "acquisition/registration/yielding_fit.h"

namespace patina {

struct ErrorLaw {
  double deviation = 0; // of a point's distance, before the fit took part of it [m]
  double together = 1;  // integrated autocorrelation: so many points in a row are worth one
  // Of what counts, in MotionScale's lengths, and of the depth at each scan's usual force where
  // that was fitted: normal equations N, and the covariance M of their right side, so that a fit's
  // is inv(N) M inv(N).
  Eigen::MatrixXd normal, scatter;

  // Of the pose in the directions that are at right angles to `free`; nothing in those.
  Mat6 covariance(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const;
};

// From what the fit left, by restricted likelihood over laws of correlation. `noise` [m]: the
// least deviation, which the path itself states. `forces`: none unless it was fitted how far the
// surface yields to them.
ErrorLaw errorLaw(const std::vector<Vec3>& points, const PathFit& fit, double noise,
                  const ScanForces& forces = {});

} // namespace patina
