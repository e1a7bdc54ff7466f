#include "acquisition/simulation/simulated_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/tracking/lens.h"

namespace patina {
namespace {

constexpr double kFlattest = 0.26; // smallest cosine between a found face and the line of sight
constexpr double kSmallest = 12;   // shortest diagonal of a found marker [px]

double easedStep(double t) {
  t = std::clamp(t, 0., 1.);
  return t * t * (3 - 2 * t);
}

} // namespace

std::vector<RigMarker> madeByHand(std::vector<RigMarker> nominal, const HandmadeRig& made,
                                  std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](double deviation) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(deviation * Vec3(x, y, z));
  };
  for (RigMarker& marker : nominal) {
    const Vec3 shift = draw(made.glue), turn = draw(made.glue_angle);
    marker.size *= made.print_scale;
    if (const double angle = turn.norm(); angle > 0)
      marker.probe_from_marker.linear() =
          Eigen::AngleAxisd(angle, turn / angle) * marker.probe_from_marker.linear();
    marker.probe_from_marker.translation() += shift;
  }
  return nominal;
}

Pose wavedPose(const WavedProbe& probe, double t) {
  std::mt19937 random(probe.seed);
  std::uniform_real_distribution<double> unit(0, 2 * std::numbers::pi);
  const double rest = probe.seconds * 11 / 12;
  const double moved = std::min(t, rest);
  const auto wave = [&](double first, double second) { // within 1
    const double a = unit(random), b = unit(random);
    return 0.6 * std::sin(2 * std::numbers::pi * first * moved + a) +
           0.4 * std::sin(2 * std::numbers::pi * second * moved + b);
  };
  const double lean = probe.tilt * wave(0.19, 0.31), sway = probe.tilt * wave(0.23, 0.37),
               roll = std::numbers::pi * wave(0.11, 0.17);
  const Vec3 away(0.04 * wave(0.29, 0.5), 0.03 * wave(0.33, 0.41), 0.06 * wave(0.21, 0.47));
  const double waved = 1 - easedStep(t - probe.seconds / 2);
  Pose pose = Pose::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()) * Eigen::AngleAxisd(lean, Vec3::UnitX()) *
       Eigen::AngleAxisd(sway, Vec3::UnitY()) * Eigen::AngleAxisd(roll, Vec3::UnitZ()))
          .toRotationMatrix();
  pose.translation() = probe.dimple + waved * away - pose.linear() * probe.tip;
  return pose;
}

std::vector<SeenMarker> projectedMarkers(const std::vector<RigMarker>& markers,
                                         const Pose& camera_from_probe, const Camera& camera,
                                         double deviation, std::mt19937& random) {
  std::normal_distribution<double> noise(0, deviation);
  std::vector<SeenMarker> seen;
  for (const RigMarker& marker : markers) {
    const Pose face = camera_from_probe * marker.probe_from_marker;
    const double cosine = -face.translation().normalized().dot(face.linear().col(2));
    if (cosine < kFlattest) continue;
    SeenMarker found{marker.family, marker.id, 0, {}, deviation};
    bool whole = true;
    for (std::size_t i = 0; i < 4; ++i) {
      FittedCorner& corner = found.corner[i];
      const Vec3 place = camera_from_probe * marker.corners()[i];
      const double u = noise(random), v = noise(random);
      corner.pixel = pixelOf(camera, place) + Vec2(u, v);
      corner.whiten = Eigen::Matrix2d::Identity() / deviation;
      const auto straight = undistortedPoint(camera, corner.pixel);
      whole = whole && straight && place.z() > 0 && corner.pixel.minCoeff() > 2 &&
              corner.pixel.x() < camera.width - 3 && corner.pixel.y() < camera.height - 3;
      corner.undistorted = straight.value_or(corner.pixel);
    }
    const double across = std::min((found.corner[0].pixel - found.corner[2].pixel).norm(),
                                   (found.corner[1].pixel - found.corner[3].pixel).norm());
    if (whole && across >= kSmallest) seen.push_back(found);
  }
  return seen;
}

} // namespace patina
