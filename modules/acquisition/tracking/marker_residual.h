// Residual of one marker's corners in one frame, and its derivatives by everything that moves them.
#pragma once

#include <optional>

#include "acquisition/tracking/marker_finder.h"

namespace patina {

struct MarkerResidual {
  Eigen::Matrix<double, 8, 1> error; // errors of the corners in order, whitened by their deviations
  // Derivatives by motions of the rig in the camera's frame and of the marker in the probe's frame:
  // shift [m], then turn about the frame's axes through the moving origin [rad].
  Eigen::Matrix<double, 8, 6> by_frame, by_marker;
  Eigen::Matrix<double, 8, 1> by_size; // derivative by the logarithm of the marker's size
};

// Returns nullopt if a corner lies behind the camera.
std::optional<MarkerResidual> markerResidual(const SeenMarker& seen, const RigMarker& marker,
                                             const Pose& camera_from_probe, const Camera& camera);

// Returns the pose after a shift of the origin and a turn about it.
Pose movedPose(const Pose& pose, const Eigen::Matrix<double, 6, 1>& motion);

inline double angleBetween(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

// The matrix of v x.
inline Eigen::Matrix3d crossMatrix(const Vec3& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

} // namespace patina
