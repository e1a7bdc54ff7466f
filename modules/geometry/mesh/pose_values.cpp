#include "geometry/mesh/pose_values.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kDegree = M_PI / 180;

// Uses exact values for multiples of 90 degrees, so that the matrix has no rounding residue.
Eigen::Matrix3d turn(int axis, double degrees) {
  const double quarters = degrees / 90;
  double s = std::sin(degrees * kDegree), c = std::cos(degrees * kDegree);
  if (quarters == std::round(quarters)) {
    s = std::round(s);
    c = std::round(c);
  }
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  matrix(u, u) = matrix(v, v) = c;
  matrix(v, u) = s;
  matrix(u, v) = -s;
  return matrix;
}

} // namespace

Pose poseOf(const PoseValues& values) {
  Pose pose = Pose::Identity();
  pose.linear() =
      turn(2, values.angles_deg[2]) * turn(1, values.angles_deg[1]) * turn(0, values.angles_deg[0]);
  pose.translation() = values.position_mm / 1000;
  return pose;
}

PoseValues valuesOf(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  PoseValues values;
  values.position_mm = 1000 * pose.translation();
  const double level = std::hypot(r(0, 0), r(1, 0));
  const double y = std::atan2(-r(2, 0), level);
  const bool upright = level < 1e-9;
  const double x = upright ? std::atan2(-r(1, 2), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
  const double z = upright ? 0 : std::atan2(r(1, 0), r(0, 0));
  values.angles_deg = Vec3(x, y, z) / kDegree;
  return values;
}

} // namespace patina
