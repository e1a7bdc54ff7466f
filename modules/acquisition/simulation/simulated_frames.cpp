#include "acquisition/simulation/simulated_frames.h"

#include <algorithm>
#include <numbers>

namespace patina {
namespace {

constexpr int kMoments = 4; // of an exposure

Pose probeAt(const SimulatedHand& hand, const ProbeModel& probe, const FrameCourse& course,
             double t) {
  const HandState state = handAt(hand, t);
  Pose world_from_probe = Pose::Identity();
  world_from_probe.linear() = state.orientation.toRotationMatrix();
  world_from_probe.translation() = state.tip - state.orientation * probe.tip;
  return course.camera_from_world * world_from_probe;
}

} // namespace

std::vector<RigMarker> markerCube(const std::string& family, int side, double edge) {
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

int frameCount(const SimulatedHand& hand, const FrameCourse& course) {
  return static_cast<int>(hand.seconds() * course.rate);
}

GreyFrame frameAt(const FrameRenderer& renderer, const SimulatedHand& hand, const ProbeModel& probe,
                  const FrameCourse& course, int i) {
  const double t = i / course.rate;
  std::vector<Pose> poses;
  for (int k = 0; k < kMoments; ++k)
    poses.push_back(
        probeAt(hand, probe, course, t + course.exposure * ((k + 0.5) / kMoments - 0.5)));
  FrameLook look = course.look;
  const bool covered = std::any_of(course.covered.begin(), course.covered.end(),
                                   [&](const Gap& gap) { return t >= gap.from && t < gap.to; });
  if (covered) look.occluders.push_back({renderer.pixelOf(poses[0].translation()), 1e3});
  return renderer.render(poses, look, course.seed * 100003u + static_cast<std::uint32_t>(i));
}

} // namespace patina
