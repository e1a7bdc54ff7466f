// Frames of a marker cube in known poses.
#pragma once

#include <numbers>
#include <random>

#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/tracking/rig_pose.h"

namespace patina::test {

inline Camera smallCamera() {
  return {640, 480, 600, 602, 322, 238, {-0.08, 0.03, 3e-4, -2e-4, 0}};
}
inline Camera largeCamera() {
  return {1920, 1080, 1500, 1500, 955, 545, {-0.08, 0.03, 3e-4, -2e-4, 0}};
}
// Distortion moves the corners of its picture inwards by a tenth.
inline Camera wideCamera() {
  return {800, 600, 420, 420, 410, 290, {-0.22, 0.06, -5e-4, 4e-4, -0.006}};
}

// A result of OpenCV's calibration with CALIB_RATIONAL_MODEL, THIN_PRISM_MODEL and TILTED_MODEL.
inline Camera rationalCamera() {
  return {800, 600, 420, 424, 410, 290, {0.31, -0.05, 2e-4, -3e-4, 2e-3, 0.42, -0.05, 4e-3}};
}
inline Camera tiltedCamera() {
  return {800,
          600,
          520,
          520,
          410,
          290,
          {-0.1, 0.02, 2e-4, -3e-4, 1e-3, 0.02, 0.01, 1e-3, 2e-3, -1e-3, -3e-3, 2e-3, 0.04, -0.03}};
}
// The corners of its picture are 67 degrees from the axis.
inline Camera fisheyeCamera() {
  Camera camera{640, 480, 340, 340, 320, 240, {-0.05, 0.01, -2e-3, 3e-4}};
  camera.lens = LensModel::fisheye;
  return camera;
}

// A cube whose markers 0 to 4 are on the faces +z, -y, +y, +x and -x, each with its margin of a
// bit.
inline std::vector<RigMarker> turnedCube(const std::string& family, int side, double edge) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto turn = [](double angle, const Vec3& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  const Eigen::Matrix3d faces[] = {Eigen::Matrix3d::Identity(), turn(kQuarter, Vec3::UnitX()),
                                   turn(-kQuarter, Vec3::UnitX()), turn(kQuarter, Vec3::UnitY()),
                                   turn(-kQuarter, Vec3::UnitY())};
  std::vector<RigMarker> markers;
  for (const Eigen::Matrix3d& face : faces) {
    RigMarker marker{family, static_cast<int>(markers.size()), edge * (side + 2) / (side + 4),
                     Pose::Identity()};
    marker.probe_from_marker.linear() = face;
    marker.probe_from_marker.translation() = face * Vec3(0, 0, edge / 2);
    markers.push_back(marker);
  }
  return markers;
}

struct RenderedRig {
  RenderedRig(const Camera& lens, const std::string& name, double edge = 0.04)
      : camera(lens), family(&markerFamily(name)),
        markers(turnedCube(name, family->side, edge)), books{CodeBook(*family, {0, 1, 2, 3, 4})},
        renderer(camera, printed()) {}

  std::vector<PrintedMarker> printed() const {
    std::vector<PrintedMarker> out;
    for (const RigMarker& marker : markers)
      out.push_back({marker, family->side, family->code[static_cast<std::size_t>(marker.id)]});
    return out;
  }
  SeenRig track(const GreyFrame& image, const Pose* previous_pose = nullptr) const {
    return poseOf(findMarkers(image, books, &camera), markers, camera, previous_pose, &image);
  }

  Camera camera;
  const MarkerFamily* family;
  std::vector<RigMarker> markers;
  std::vector<CodeBook> books;
  FrameRenderer renderer;
};

// Faces look at the camera, tilted by up to `tilt` about x and y [rad].
inline Pose somePose(std::mt19937& random, double distance = 0.4, double tilt = 0.6) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto turn = [](double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis); };
  Pose pose = Pose::Identity();
  const double x = unit(random), y = unit(random), z = unit(random);
  pose.translation() = distance * Vec3(0.1 * x, 0.07 * y, 1 + 0.05 * z);
  const double a = unit(random), b = unit(random), c = unit(random);
  pose.linear() = (turn(3.14159265, Vec3::UnitX()) * turn(tilt * a, Vec3::UnitX()) *
                   turn(tilt * b, Vec3::UnitY()) * turn(3 * c, Vec3::UnitZ()))
                      .toRotationMatrix();
  return pose;
}

inline const Vec3 kTip(0, 0, -0.12); // tip in the probe's frame [m]

} // namespace patina::test
