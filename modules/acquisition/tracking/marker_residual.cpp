#include "acquisition/tracking/marker_residual.h"

namespace patina {

std::optional<MarkerResidual> markerResidual(const SeenMarker& seen, const RigMarker& marker,
                                             const Pose& camera_from_probe, const Camera& camera) {
  MarkerResidual residual;
  const Vec3 middle = marker.probe_from_marker.translation();
  const std::array<Vec3, 4> corners = marker.corners();
  for (int i = 0; i < 4; ++i) {
    const Vec3& corner = corners[static_cast<std::size_t>(i)];
    const Vec3 arm = camera_from_probe.linear() * corner, p = arm + camera_from_probe.translation();
    if (!(p.z() > 1e-6)) return std::nullopt;
    const FittedCorner& found = seen.corner[static_cast<std::size_t>(i)];
    const Vec2 pixel(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
    residual.error.segment<2>(2 * i) = found.whiten * (pixel - found.undistorted);
    Eigen::Matrix<double, 2, 3> by_place;
    by_place << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0, camera.fy / p.z(),
        -camera.fy * p.y() / (p.z() * p.z());
    by_place = (found.whiten * by_place).eval();
    residual.by_frame.block<2, 3>(2 * i, 0) = by_place;
    residual.by_frame.block<2, 3>(2 * i, 3) = -by_place * crossMatrix(arm);
    const Eigen::Matrix<double, 2, 3> by_corner = by_place * camera_from_probe.linear();
    residual.by_marker.block<2, 3>(2 * i, 0) = by_corner;
    residual.by_marker.block<2, 3>(2 * i, 3) = -by_corner * crossMatrix(corner - middle);
    residual.by_size.segment<2>(2 * i) = by_corner * (corner - middle);
  }
  return residual;
}

Pose movedPose(const Pose& pose, const Eigen::Matrix<double, 6, 1>& motion) {
  Pose out = pose;
  const Vec3 turn = motion.tail<3>();
  if (const double angle = turn.norm(); angle > 0)
    out.linear() = Eigen::AngleAxisd(angle, turn / angle) * pose.linear();
  out.translation() += motion.head<3>();
  return out;
}

} // namespace patina
