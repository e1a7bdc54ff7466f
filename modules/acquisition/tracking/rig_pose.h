// The pose of a body of markers from one picture (A04): all its markers at once, with error bars.
#pragma once

#include "acquisition/tracking/marker_finder.h"

namespace patina {

enum class RigVerdict {
  seen,
  no_marker,
  ambiguous, // seen so flatly that it may as well be tilted the other way
  misfit     // its markers are not where the rig has them
};
std::string_view nameOf(RigVerdict verdict);

struct SeenRig {
  RigVerdict verdict = RigVerdict::no_marker;
  Pose camera_from_probe = Pose::Identity();
  // Of the position [m], then of a turn about the camera's axes [rad].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::size_t markers = 0; // that it follows from
  std::size_t dropped = 0; // that contradict the others
  double rms = 0;          // of their corners, each as exactly as it is known [px]
};

// Where the corners leave two poses, the faces decide of which no marker was found, if there is an
// `image` to look at; and where it does not say, `lately` does, if the rig cannot have turned as
// far since.
SeenRig poseOf(const std::vector<SeenMarker>& seen, const std::vector<RigMarker>& rig,
               const Camera& camera, const Pose* lately = nullptr,
               const GreyFrame* image = nullptr);

} // namespace patina
