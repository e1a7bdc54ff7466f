// The pose of a body of markers from one picture (A04): all its markers at once, with error bars.
#pragma once

#include "acquisition/tracking/marker_finder.h"

namespace patina {

enum class RigVerdict {
  seen,
  no_marker,
  ambiguous, // seen so flatly that it may as well be tilted the other way
  misfit,    // its markers are not where the rig has them
  repeated   // each of its markers that is seen is seen more than once
};
std::string_view nameOf(RigVerdict verdict);

// A marker of the rig that a frame shows more than once, so that none of its images counts.
struct RepeatedMarker {
  std::string family;
  int id = 0;
  std::vector<Vec2> places; // of its middles [px]
};
// "marker 0 of 4x4_50 is seen twice, at (160, 239) and (480, 241) px".
std::string textOf(const RepeatedMarker& marker);

struct SeenRig {
  RigVerdict verdict = RigVerdict::no_marker;
  Pose camera_from_probe = Pose::Identity();
  // Of the position [m], then of a turn about the camera's axes [rad].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::size_t markers = 0; // that it follows from
  std::size_t dropped = 0; // that contradict the others
  double rms = 0;          // of their corners, each as exactly as it is known [px]
  std::vector<RepeatedMarker> repeated;
};
// Says why there is no pose.
std::string reasonOf(const SeenRig& seen);

// Where the corners leave two poses, the faces decide of which no marker was found, if there is an
// `image` to look at; and where it does not say, `lately` does, if the rig cannot have turned as
// far since.
SeenRig poseOf(const std::vector<SeenMarker>& seen, const std::vector<RigMarker>& rig,
               const Camera& camera, const Pose* lately = nullptr,
               const GreyFrame* image = nullptr);

} // namespace patina
