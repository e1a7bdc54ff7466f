// Typed numbers against rotations composed by Eigen.
#include <random>

#include <gtest/gtest.h>

#include "geometry/mesh/pose_values.h"

namespace patina {
namespace {

TEST(PoseValues, RotateAboutXThenYThenZAndTranslateInMillimetres) {
  const PoseValues values{Vec3(1, -2, 3), Vec3(20, -35, 110)};
  const auto about = [&](int axis) {
    return Eigen::AngleAxisd(values.angles_deg[axis] * M_PI / 180, Vec3::Unit(axis));
  };
  const Eigen::Matrix3d expected = (about(2) * about(1) * about(0)).toRotationMatrix();
  const Pose pose = poseOf(values);
  EXPECT_LT((pose.linear() - expected).norm(), 1e-14);
  EXPECT_LT((pose.translation() - Vec3(1e-3, -2e-3, 3e-3)).norm(), 1e-18);
}

TEST(PoseValues, ReadBackToTheSamePose) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const PoseValues values{100 * Vec3(any(random), any(random), any(random)),
                            Vec3(180 * any(random), 90 * any(random), 180 * any(random))};
    const Pose pose = poseOf(values);
    const PoseValues back = valuesOf(pose);
    ASSERT_LT((poseOf(back).matrix() - pose.matrix()).norm(), 1e-12);
    ASSERT_LT((back.angles_deg - values.angles_deg).norm(), 1e-7);
  }
  for (const double y : {-90.0, 90.0}) { // x and z rotate about the same axis there
    const Pose pose = poseOf({Vec3::Zero(), Vec3(30, y, 50)});
    const PoseValues back = valuesOf(pose);
    EXPECT_EQ(back.angles_deg[2], 0);
    EXPECT_LT((poseOf(back).matrix() - pose.matrix()).norm(), 1e-12);
  }
}

// T-A09: the axes stay fixed during the rotations.
TEST(PoseValues, RotateAboutFixedAxes) {
  const Pose once = poseOf({Vec3::Zero(), Vec3(90, 0, 0)});
  EXPECT_EQ(once * Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()));
  // About x, y goes to z; about the fixed y, z then goes to x. Rotated axes would leave it at z.
  const Pose twice = poseOf({Vec3::Zero(), Vec3(90, 90, 0)});
  EXPECT_EQ(twice * Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX()));
  EXPECT_EQ(twice * Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitY()));
}

TEST(PoseValues, QuarterTurnsAndTheIdentityAreExact) {
  EXPECT_TRUE(poseOf({}).matrix().isIdentity(0));
  const Eigen::Matrix3d quarter = poseOf({Vec3::Zero(), Vec3(0, 0, 90)}).linear();
  EXPECT_EQ(quarter(0, 0), 0);
  EXPECT_EQ(quarter(1, 0), 1);
}

} // namespace
} // namespace patina
