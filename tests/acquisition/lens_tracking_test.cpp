// Markers behind lenses of every model: poses, and whether their error bars hold.
#include <gtest/gtest.h>

#include <cmath>

#include "core/decompose.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

struct Tracked {
  int seen = 0, frames = 0;
  double worst = 0; // largest position error [m]
  double nees = 0;  // mean of the squared errors over their covariance, 6 if those hold
};

// The rig in front of the camera, `aside` of the axis [rad].
Tracked trackBehind(const Camera& camera, double aside) {
  const test::RenderedRig rig(camera, "4x4_50");
  std::mt19937 random(4);
  Tracked result;
  for (int i = 0; i < 12; ++i) {
    Pose pose = test::somePose(random, 0.3, 0.4);
    const double around = 0.5 * i;
    pose = Pose(Eigen::AngleAxisd(aside, Vec3(std::sin(around), -std::cos(around), 0))) * pose;
    const GreyFrame image = rig.renderer.render({pose}, {}, static_cast<std::uint32_t>(i));
    const SeenRig seen = rig.track(image);
    ++result.frames;
    if (seen.verdict != RigVerdict::seen) continue;
    ++result.seen;
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = seen.camera_from_probe.translation() - pose.translation();
    const Eigen::AngleAxisd turn(seen.camera_from_probe.linear() * pose.linear().transpose());
    error.tail<3>() = turn.angle() * turn.axis();
    result.worst = std::max(result.worst, error.head<3>().norm());
    result.nees += error.dot(SymmetricSolver(seen.covariance).solve(error));
  }
  result.nees /= result.seen;
  return result;
}

TEST(LensTracking, FindsPosesBehindEveryLens) {
  struct Row {
    const char* name;
    Camera camera;
    double aside;
  };
  const Row rows[] = {{"brown", test::wideCamera(), 0.4},
                      {"rational", test::rationalCamera(), 0.4},
                      {"tilted", test::tiltedCamera(), 0.3},
                      {"fisheye, at the middle", test::fisheyeCamera(), 0.1},
                      {"fisheye, 29 degrees aside", test::fisheyeCamera(), 0.5},
                      {"fisheye, 46 degrees aside", test::fisheyeCamera(), 0.8}};
  for (const Row& row : rows) {
    const Tracked found = trackBehind(row.camera, row.aside);
    std::printf("%s: %d of %d, worst %.3f mm, NEES %.1f\n", row.name, found.seen, found.frames,
                1e3 * found.worst, found.nees);
    EXPECT_GE(found.seen, 0.7 * found.frames) << row.name;
    EXPECT_LT(found.worst, 1e-3) << row.name;
    EXPECT_LT(found.nees, 12) << row.name;
  }
}

} // namespace
} // namespace patina
