// Pose of a rig of markers from one picture, as a joint fit with covariance (A04).
#pragma once

#include "acquisition/tracking/marker_finder.h"

namespace patina {

enum class RigVerdict {
  seen,
  no_marker,
  ambiguous, // planar pose ambiguity: two tilts fit
  misfit,    // markers are not where the rig file has them
  repeated   // every visible marker of the rig is detected more than once
};
std::string_view nameOf(RigVerdict verdict);

// A marker that is detected more than once in a frame; none of its detections is used.
struct RepeatedMarker {
  std::string family;
  int id = 0;
  std::vector<Vec2> places; // centers [px]
};
// Returns "marker 0 of 4x4_50 is seen twice, at (160, 239) and (480, 241) px".
std::string textOf(const RepeatedMarker& marker);

struct SeenRig {
  RigVerdict verdict = RigVerdict::no_marker;
  Pose camera_from_probe = Pose::Identity();
  // Covariance of the position [m], then of a rotation about the camera's axes [rad].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::size_t markers = 0;       // number of markers used
  std::vector<std::size_t> used; // their places in the rig
  std::size_t dropped = 0;       // number of outlier markers
  double rms = 0;                // reprojection error of the corners, weighted by accuracy [px]
  std::vector<RepeatedMarker> repeated;
};
// Returns the reason why there is no pose.
std::string reasonOf(const SeenRig& seen);

// Resolves the planar pose ambiguity. First the appearance of the undetected markers in `image`
// decides; if that is inconclusive, `previous_pose` decides, provided the rig cannot have rotated
// that far since.
SeenRig poseOf(const std::vector<SeenMarker>& seen, const std::vector<RigMarker>& rig,
               const Camera& camera, const Pose* previous_pose = nullptr,
               const GreyFrame* image = nullptr);

} // namespace patina
