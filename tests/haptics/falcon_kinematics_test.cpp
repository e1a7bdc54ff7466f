// The Falcon's kinematics against the linkage itself, solved by bisection in long double.
#include "haptics/falcon/falcon_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "haptics/falcon/falcon_device.h"

namespace patina {
namespace {

const FalconShape kShape{};

// Closure error of leg i's linkage: squared distance of its parallelogram's end from the handle
// [m^2].
long double misses(const Vec3& p, double leg, long double theta) {
  const long double c = std::cos(static_cast<long double>(leg));
  const long double s = std::sin(static_cast<long double>(leg));
  const long double pu = p.x() * c + p.y() * s - 0.040L, pw = p.z();
  const long double pv = -p.x() * s + p.y() * c - 0.02309L;
  const long double third = std::acos((pv + 0.025L) / 0.1025L);
  const long double reach = 0.0225L + 0.1025L * std::sin(third);
  const long double u = pu + 0.01443L - 0.060L * std::cos(theta);
  const long double w = pw - 0.060L * std::sin(theta);
  return u * u + w * w - reach * reach;
}

// Returns the closure whose knee points outwards.
double thighByBisection(const Vec3& p, double leg) {
  const long double pu = p.x() * std::cos(leg) + p.y() * std::sin(leg) - 0.040 + 0.01443;
  long double in = std::atan2(static_cast<long double>(p.z()), pu);
  long double out = in - std::numbers::pi_v<long double>;
  if (!(misses(p, leg, in) < 0 && misses(p, leg, out) > 0))
    return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 80; ++i) {
    const long double middle = (in + out) / 2;
    (misses(p, leg, middle) > 0 ? out : in) = middle;
  }
  return static_cast<double>(in);
}

double turnOf(int leg) {
  return (90 - 120 * leg + 15) * std::numbers::pi / 180;
}

Angles thighs(const Vec3& p) {
  Angles angles;
  for (int i = 0; i < 3; ++i) angles[i] = thighByBisection(p, turnOf(i));
  return angles;
}

// The workspace has the symmetry of the base.
Vec3 inWorkspace(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  Vec3 share;
  do {
    share = Vec3(part(random), part(random), part(random));
  } while (share.head<2>().norm() > 1);
  return kFalconCentre + share.cwiseProduct(kFalconWorkspace.max());
}

TEST(FalconKinematics, AnglesMatchTheLinkage) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = inWorkspace(random);
    const auto angles = falconAngles(kShape, p);
    ASSERT_TRUE(angles.has_value()) << p.transpose();
    ASSERT_LT((*angles - thighs(p)).lpNorm<Eigen::Infinity>(), 1e-13) << p.transpose();
  }
}

// A million poses: the residual by the linkage for each thousandth, by the closed form for all.
TEST(FalconKinematics, FindsAMillionPosesFromAnglesInAtMostSixSteps) {
  std::mt19937 random(2);
  double residual = 0, apart = 0;
  int max_steps = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const Vec3 p = inWorkspace(random);
    const Angles angles = i % 1000 == 0 ? thighs(p) : *falconAngles(kShape, p);
    const FalconPose pose = falconPose(kShape, angles);
    ASSERT_FALSE(pose.singular) << p.transpose();
    const auto back = falconAngles(kShape, pose.handle);
    ASSERT_TRUE(back.has_value());
    residual = std::max(residual, (*back - angles).lpNorm<Eigen::Infinity>());
    if (i % 1000 == 0)
      residual = std::max(residual, (thighs(pose.handle) - angles).lpNorm<Eigen::Infinity>());
    apart = std::max(apart, (pose.handle - p).norm());
    max_steps = std::max(max_steps, pose.steps);
  }
  EXPECT_LE(residual, 1e-9); // [rad]; 3.5e-14 measured
  EXPECT_LE(apart, 1e-9);    // [m]; 3.5e-15 measured
  EXPECT_LE(max_steps, kFalconSteps);
  std::printf("residual %.2g rad, round trip %.2g m, %d steps\n", residual, apart, max_steps);
}

TEST(FalconKinematics, TakesFewStepsFromTheLastPose) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 5e-4); // [m] a tick: 0.5 m/s
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = inWorkspace(random);
    const Vec3 before = p + Vec3(step(random), step(random), step(random));
    const FalconPose pose = falconPose(kShape, *falconAngles(kShape, p), before);
    ASSERT_LE(pose.steps, 4);
    ASSERT_LT((pose.handle - p).norm(), 1e-9);
  }
}

// Any 16 bits of an encoder, and worse.
TEST(FalconKinematics, EveryAngleGivesAFinitePoseMarkedValidOrNot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-25, 25);
  int poses = 0;
  for (int i = 0; i < 50000; ++i) {
    const Angles angles(any(random), any(random), any(random));
    const FalconPose pose = falconPose(kShape, angles);
    ASSERT_TRUE(pose.handle.allFinite() && std::isfinite(pose.residual)) << angles.transpose();
    if (!pose.singular && pose.residual <= kFalconResidual) {
      ++poses; // each linkage then closes, with its knee on either side
      for (int leg = 0; leg < 3; ++leg)
        ASSERT_LT(std::abs(misses(pose.handle, turnOf(leg), angles[leg])), 1e-10);
    }
  }
  EXPECT_GT(poses, 1000);
  for (const double bad : {nan, HUGE_VAL, -HUGE_VAL}) {
    const FalconPose pose = falconPose(kShape, Angles(0.4, bad, 0.4));
    EXPECT_TRUE(pose.singular);
    EXPECT_TRUE(pose.handle.allFinite());
  }
}

// Stretched until the three shanks lie in a plane: the handle could be pushed through it.
TEST(FalconKinematics, SingularPoseIsFiniteAndReported) {
  const double flat = std::acos((0.125 - 0.060 + 0.0 - 0.040 + 0.01443 + 0.0) / 0.125);
  std::vector<Angles> cases{Angles::Constant(std::numbers::pi / 2 + flat)};
  for (double angle = -3; angle <= 3; angle += 1e-3) cases.push_back(Angles::Constant(angle));
  int singular = 0;
  for (const Angles& angles : cases) {
    const FalconPose pose = falconPose(kShape, angles);
    ASSERT_TRUE(pose.handle.allFinite() && std::isfinite(pose.residual));
    const auto torques = falconTorques(kShape, pose.handle, angles, Vec3(1, 2, 3));
    if (torques) {
      ASSERT_TRUE(torques->allFinite());
    } else {
      ++singular;
    }
  }
  EXPECT_GT(singular, 0);
}

TEST(FalconKinematics, TorquesDoTheSameWorkAsTheForce) {
  std::mt19937 random(5);
  std::normal_distribution<double> any(0, 1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = inWorkspace(random);
    const Vec3 force(any(random), any(random), any(random));
    const auto torques = falconTorques(kShape, p, *falconAngles(kShape, p), force);
    ASSERT_TRUE(torques.has_value());
    const Vec3 step = 1e-6 * Vec3(any(random), any(random), any(random)).normalized();
    const double work = torques->dot(thighs(p + step) - thighs(p - step)); // central difference
    ASSERT_NEAR(work, 2 * force.dot(step), 1e-9 * force.norm() * 1e-2 + 1e-11);
  }
}

} // namespace
} // namespace patina
