#include "acquisition/filtering/camera_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquisition/simulation/simulated_streams.h"

namespace patina {
namespace {

const Vec3 kTip(0, 0, -0.12);

// A slow circle without noise; the sigmas state an assumed noise.
CameraPose poseAt(double t) {
  CameraPose pose;
  pose.t = t;
  pose.orientation = Eigen::AngleAxisd(0.2 * std::sin(t), Vec3::UnitX());
  pose.position = Vec3(0.05 * std::cos(t), 0.05 * std::sin(t), 0.4) - pose.orientation * kTip;
  return pose;
}

Vec3 tipAt(double t) {
  return {0.05 * std::cos(t), 0.05 * std::sin(t), 0.4};
}

std::vector<CameraPose> circle(double seconds, double rate = 30) {
  std::vector<CameraPose> poses;
  for (int i = 0; i < seconds * rate; ++i) poses.push_back(poseAt(i / rate));
  return poses;
}

std::ptrdiff_t countOf(const CameraTrack& track, PoseVerdict verdict) {
  return std::count(track.verdicts.begin(), track.verdicts.end(), verdict);
}

TEST(CameraTrack, FollowsACircle) {
  const CameraTrack track = trackTip(circle(10), kTip);
  EXPECT_EQ(track.used(), 300u);
  for (double t = 1; t < 9; t += 0.037) {
    const TipMotion motion = motionAt(track, t);
    EXPECT_NEAR((motion.position - tipAt(t)).norm(), 0, 20e-6) << t;
    EXPECT_NEAR((motion.velocity - Vec3(-tipAt(t).y(), tipAt(t).x(), 0)).norm(), 0, 1e-3) << t;
    EXPECT_NEAR(motion.rate.x(), 0.2 * std::cos(t), 5e-3) << t;
    EXPECT_NEAR(motion.rate_of_rate.x(), -0.2 * std::sin(t), 0.05) << t;
    EXPECT_FALSE(motion.gap);
  }
}

TEST(CameraTrack, ReportsWhyAPoseIsRejected) {
  std::vector<CameraPose> poses = circle(4);
  poses[40].position.x() += 1;              // 1 m off
  poses[50].position.y() = std::nan("");    // no number
  poses[60].t = poses[59].t;                // the same time again
  poses[70].t = poses[60].t;                // back in time
  poses[80].orientation.coeffs().setZero(); // no orientation
  poses[90].orientation = poses[90].orientation * Eigen::AngleAxisd(1, Vec3::UnitY()); // a flip
  const CameraTrack track = trackTip(poses, kTip);
  EXPECT_EQ(track.verdicts[40], PoseVerdict::outlier);
  EXPECT_EQ(track.verdicts[50], PoseVerdict::not_finite);
  EXPECT_EQ(track.verdicts[60], PoseVerdict::repeated);
  EXPECT_EQ(track.verdicts[70], PoseVerdict::backwards);
  EXPECT_EQ(track.verdicts[80], PoseVerdict::not_finite);
  EXPECT_EQ(track.verdicts[90], PoseVerdict::outlier);
  EXPECT_EQ(track.used(), poses.size() - 6);
  for (double t = 0.5; t < 3.5; t += 0.01)
    EXPECT_NEAR((motionAt(track, t).position - tipAt(t)).norm(), 0, 0.1e-3) << t;
}

TEST(CameraTrack, DistrustsTheFirstPoseAndThePoseAfterAGap) {
  std::vector<CameraPose> poses = circle(6);
  poses.front().position.x() += 0.1;
  poses.erase(poses.begin() + 60, poses.begin() + 98); // 1.3 s
  poses[60].position.z() += 0.05;                      // the first one after
  const CameraTrack track = trackTip(poses, kTip);
  EXPECT_EQ(track.verdicts.front(), PoseVerdict::outlier);
  EXPECT_EQ(track.verdicts[60], PoseVerdict::outlier);
  EXPECT_EQ(countOf(track, PoseVerdict::outlier), 2);
  EXPECT_EQ(track.restarts, 0u);
}

TEST(CameraTrack, RestartsAfterAJump) {
  std::vector<CameraPose> poses = circle(6);
  for (std::size_t i = 90; i < poses.size(); ++i) poses[i].position.x() += 0.2;
  const CameraTrack track = trackTip(poses, kTip);
  EXPECT_EQ(track.restarts, 1u);
  EXPECT_EQ(track.used(), poses.size());
  EXPECT_NEAR((motionAt(track, 2.8).position - tipAt(2.8)).norm(), 0, 0.2e-3);
  EXPECT_NEAR((motionAt(track, 3.2).position - tipAt(3.2) - Vec3(0.2, 0, 0)).norm(), 0, 0.2e-3);
}

TEST(CameraTrack, MarksAGapWithItsUncertainty) {
  std::vector<CameraPose> poses = circle(6);
  poses.erase(poses.begin() + 75, poses.begin() + 135); // 2 s
  const CameraTrack track = trackTip(poses, kTip);
  const TipMotion before = motionAt(track, 2.2), in = motionAt(track, 3.5);
  EXPECT_FALSE(before.gap);
  EXPECT_TRUE(in.gap);
  EXPECT_GT(in.sigma, 5 * before.sigma);
  EXPECT_LT((in.position - tipAt(3.5)).norm(), 4 * std::sqrt(3.) * in.sigma);
  EXPECT_TRUE(motionAt(track, 7).gap) << "after the last pose";
  EXPECT_GT(motionAt(track, 7).sigma, motionAt(track, 6.1).sigma);
  EXPECT_TRUE(motionAt(track, -1).gap) << "before the first one";
}

TEST(CameraTrack, AcceptsQuaternionsOfEitherSign) {
  std::vector<CameraPose> poses = circle(3), other = poses;
  for (std::size_t i = 0; i < other.size(); i += 3) other[i].orientation.coeffs() *= -1;
  const CameraTrack a = trackTip(poses, kTip), b = trackTip(other, kTip);
  for (double t = 0.1; t < 2.9; t += 0.1)
    EXPECT_LT(motionAt(a, t).orientation.angularDistance(motionAt(b, t).orientation), 1e-7);
}

TEST(CameraTrack, IsEmptyWithoutPoses) {
  EXPECT_TRUE(trackTip({}, kTip).empty());
  CameraPose broken;
  broken.t = std::nan("");
  EXPECT_TRUE(trackTip({broken}, kTip).empty());
  EXPECT_THROW(motionAt(trackTip({}, kTip), 0), std::invalid_argument);
  const CameraTrack lone = trackTip({poseAt(1)}, kTip);
  EXPECT_EQ(lone.used(), 1u);
  EXPECT_NEAR((motionAt(lone, 1).position - tipAt(1)).norm(), 0, 1e-12);
}

// Extremes of the Kalman filter: R = 0, Q = 0, and one measurement repeated many times.
TEST(CameraTrack, TakesExactAndUnmovedPoses) {
  for (const double sigma : {0., 0.2e-3})
    for (const bool moves : {false, true})
      for (const bool noise : {false, true}) {
        std::vector<CameraPose> poses = circle(4);
        for (CameraPose& pose : poses) {
          const double t = pose.t;
          if (!moves) pose = poseAt(1);
          pose.t = t;
          pose.sigma_position = pose.sigma_angle = sigma;
        }
        CameraTrackOptions options;
        if (!noise) options.position_noise = options.angle_noise = 0;
        const CameraTrack track = trackTip(poses, kTip, options);
        ASSERT_FALSE(track.empty());
        for (double t = -0.5; t < 4.5; t += 0.013) {
          const TipMotion motion = motionAt(track, t);
          ASSERT_TRUE(motion.position.allFinite() && motion.orientation.coeffs().allFinite());
          ASSERT_TRUE(motion.sigma >= 0 && motion.sigma_angle >= 0) << t;
          if (!moves) {
            ASSERT_NEAR((motion.position - tipAt(1)).norm(), 0, 1e-9) << t;
          }
        }
        if (noise) {
          EXPECT_EQ(track.used(), poses.size()) << sigma << moves;
        }
      }
}

// Each model is better than the one before; measured 0.53 and 0.46 of the raw camera.
TEST(CameraTrack, SmoothingBeatsFilteringAndAccelerationVelocity) {
  const SimulatedHand hand = strokes(1);
  const std::vector<CameraPose> poses = simulateCamera(hand, ProbeModel(), {}, 1);
  const auto rmsOf = [&](bool acceleration, bool smooth) {
    CameraTrackOptions options;
    options.acceleration = acceleration;
    options.smooth = smooth;
    const CameraTrack track = trackTip(poses, kTip, options);
    EXPECT_NEAR(track.nis_mean, 0.95, 0.15);
    double squares = 0;
    for (const CameraPose& pose : poses)
      squares += (motionAt(track, pose.t).position - handAt(hand, pose.t).tip).squaredNorm();
    return std::sqrt(squares / static_cast<double>(poses.size()));
  };
  double raw = 0;
  for (const CameraPose& pose : poses)
    raw += (pose.position + pose.orientation * kTip - handAt(hand, pose.t).tip).squaredNorm();
  raw = std::sqrt(raw / static_cast<double>(poses.size()));
  EXPECT_LT(rmsOf(false, true), 0.6 * raw);
  EXPECT_LT(rmsOf(true, true), rmsOf(false, true));
  EXPECT_LT(rmsOf(true, true), 0.8 * rmsOf(true, false));
}

} // namespace
} // namespace patina
