#include "acquisition/registration/rigid_fit.h"

#include <random>

#include <gtest/gtest.h>

#include "core/percentiles.h"

namespace patina {
namespace {

std::vector<Vec3> cloud(std::mt19937& random, std::size_t n, const Vec3& size) {
  std::normal_distribution<double> normal;
  std::vector<Vec3> points(n);
  for (Vec3& p : points)
    p = size.cwiseProduct(Vec3(normal(random), normal(random), normal(random)));
  return points;
}

Pose anyPose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = Vec3(normal(random), normal(random), normal(random));
  return pose;
}

std::vector<Vec3> moved(const std::vector<Vec3>& points, const Pose& pose) {
  std::vector<Vec3> to;
  for (const Vec3& p : points) to.push_back(pose * p);
  return to;
}

double angleBetween(const Pose& a, const Pose& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

double unlikeATurn(const Pose& pose) {
  return (pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm();
}

// T-A11a, T-A11c
TEST(RigidFit, RecoversAnyPoseWithoutNoiseByBothRoutes) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const auto from = cloud(random, 20, Vec3(0.05, 0.03, 0.02));
    const Pose truth = anyPose(random);
    const auto to = moved(from, truth);
    for (const Pose& pose : {fitRigid(from, to), fitAffineThenRigid(from, to).value()}) {
      EXPECT_LT(angleBetween(pose, truth), 5e-8); // rounding of the cosine
      EXPECT_LT((pose.linear() - truth.linear()).norm(), 1e-12);
      EXPECT_LT((pose.translation() - truth.translation()).norm(), 1e-12);
      EXPECT_LT(unlikeATurn(pose), 5e-15);
    }
  }
}

// T-A11b, F10
TEST(RigidFit, PlanarPathIsExactByOneRouteAndRejectedByTheOther) {
  std::mt19937 random(2);
  const auto from = cloud(random, 50, Vec3(0.05, 0.03, 0));
  const Pose truth = anyPose(random);
  const auto to = moved(from, truth);
  EXPECT_LT((fitRigid(from, to).linear() - truth.linear()).norm(), 1e-12);
  EXPECT_FALSE(fitAffineThenRigid(from, to).has_value());
}

// T-A11c: noise on a plane may make a mirror image the best affine fit.
TEST(RigidFit, NeverReflects) {
  std::mt19937 random(3);
  int mirrored = 0;
  for (int round = 0; round < 1000; ++round) {
    const auto from = cloud(random, 4, Vec3(0.05, 0.03, 1e-4)),
               noise = cloud(random, 4, Vec3::Constant(5e-3));
    auto to = from;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += noise[i];
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      a += from[i] / 4;
      b += to[i] / 4;
    }
    for (std::size_t i = 0; i < 4; ++i) cross += (to[i] - b) * (from[i] - a).transpose();
    mirrored += cross.determinant() < 0;
    const Pose pose = fitRigid(from, to);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-14);
    EXPECT_LT(unlikeATurn(pose), 1e-14);
  }
  EXPECT_GT(mirrored, 300);
}

TEST(RigidFit, StaysARotationAfterTenThousandSteps) {
  std::mt19937 random(4);
  const auto from = cloud(random, 10, Vec3::Constant(0.03));
  const Pose step = anyPose(random);
  Pose pose = Pose::Identity();
  for (int i = 0; i < 10'000; ++i) pose = fitRigid(from, moved(moved(from, pose), step));
  EXPECT_LT(unlikeATurn(pose), 1e-14);
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-14);
}

// T-A11d
TEST(RigidFit, ErrorHalvesWithFourTimesThePoints) {
  std::vector<double> median;
  for (const std::size_t n : {50U, 200U, 800U}) {
    std::mt19937 random(5);
    std::vector<double> errors;
    for (int round = 0; round < 400; ++round) {
      const auto from = cloud(random, n, Vec3::Constant(0.03)),
                 noise = cloud(random, n, Vec3::Constant(5e-4));
      const Pose truth = anyPose(random);
      auto to = moved(from, truth);
      for (std::size_t i = 0; i < n; ++i) to[i] += noise[i];
      errors.push_back(angleBetween(fitRigid(from, to), truth));
    }
    median.push_back(percentiles(errors).p50);
    // Each axis depends on the spread of the two others.
    const double expected = 5e-4 / (0.03 * std::sqrt(2.0 * static_cast<double>(n)));
    EXPECT_NEAR(median.back() / (expected * 1.538), 1, 0.1);
  }
  EXPECT_NEAR(median[0] / median[1], 2, 0.2);
  EXPECT_NEAR(median[1] / median[2], 2, 0.2);
}

TEST(RigidFit, RejectsUnpairedPoints) {
  EXPECT_THROW(fitRigid({}, {}), std::invalid_argument);
  EXPECT_THROW(fitRigid({Vec3::Zero()}, {}), std::invalid_argument);
  EXPECT_THROW(fitAffineThenRigid({}, {}), std::invalid_argument);
}

} // namespace
} // namespace patina
