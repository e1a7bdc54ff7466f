#include "acquisition/tracking/rig_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "acquisition/files/frame_files.h"
#include "acquisition/tracking/track_frames.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

using test::kTip;
using test::RenderedRig;
using test::somePose;
using Vec6 = Eigen::Matrix<double, 6, 1>;

Vec6 poseError(const Pose& found, const Pose& known) {
  Vec6 error;
  const Eigen::AngleAxisd turn(found.linear() * known.linear().transpose());
  error << found.translation() - known.translation(), turn.angle() * turn.axis();
  return error;
}

TEST(RigPose, FindsTheTipAndItsDeviation) {
  const struct {
    Camera camera;
    const char* family;
    double distance, most; // tip rms [m]
  } settings[] = {{test::smallCamera(), "4x4_50", 0.4, 0.4e-3},
                  {test::largeCamera(), "apriltag_36h11", 0.4, 0.08e-3},
                  {test::wideCamera(), "5x5_100", 0.3, 0.4e-3}};
  for (const auto& s : settings) {
    const RenderedRig rig(s.camera, s.family);
    std::mt19937 random(4);
    double squares = 0, nees = 0;
    int poses = 0;
    for (std::uint32_t i = 0; i < 20; ++i) {
      const Pose known = somePose(random, s.distance, 0.8);
      const SeenRig seen = rig.track(rig.renderer.render({known}, {}, i));
      if (seen.verdict == RigVerdict::ambiguous) continue; // one face seen from the front
      ASSERT_EQ(seen.verdict, RigVerdict::seen) << nameOf(seen.verdict);
      ++poses;
      squares += (seen.camera_from_probe * kTip - known * kTip).squaredNorm();
      const Vec6 error = poseError(seen.camera_from_probe, known);
      nees += error.dot(SymmetricSolver(seen.covariance).solve(error)) / 6;
    }
    std::printf("%s: tip %.3f mm, NEES %.2f of %d poses\n", s.family,
                1e3 * std::sqrt(squares / poses), nees / poses, poses);
    EXPECT_GE(poses, 17);
    EXPECT_LT(std::sqrt(squares / poses), s.most);
    // The stated deviation lies between half and twice the true one.
    EXPECT_GT(nees / poses, 0.25);
    EXPECT_LT(nees / poses, 4);
  }
}

// Background that shows through narrow borders shifts blurred edges; the covariance covers it.
TEST(RigPose, CovarianceCoversBlur) {
  // The part of the large camera's picture that contains the rig at this distance.
  Camera middleOfLarge = test::largeCamera();
  middleOfLarge.width = 800, middleOfLarge.height = 640;
  middleOfLarge.cx -= 560, middleOfLarge.cy -= 220;
  const struct {
    Camera camera;
    const char* family;
    double distance;
  } settings[] = {{test::smallCamera(), "apriltag_36h11", 0.4},
                  {test::smallCamera(), "4x4_50", 0.4},
                  {test::smallCamera(), "6x6_250", 0.35},
                  {middleOfLarge, "apriltag_36h11", 0.4},
                  {test::wideCamera(), "5x5_100", 0.3}};
  for (const auto& s : settings) {
    const RenderedRig rig(s.camera, s.family);
    double all = 0, frames = 0;
    for (const double blur : {0.4, 1.2, 1.8, 2.5}) {
      std::mt19937 random(21);
      FrameLook look;
      look.blur = blur;
      double nees = 0, poses = 0;
      for (std::uint32_t i = 0; i < 12; ++i) {
        const Pose known = somePose(random, s.distance);
        const SeenRig seen = rig.track(rig.renderer.render({known}, look, i));
        if (seen.verdict != RigVerdict::seen) continue;
        const Vec6 error = poseError(seen.camera_from_probe, known);
        nees += error.dot(SymmetricSolver(seen.covariance).solve(error)) / 6;
        poses += 1;
      }
      std::printf("%s, blur %.1f: NEES %.2f of %.0f poses\n", s.family, blur, nees / poses, poses);
      EXPECT_GE(poses, 9);
      EXPECT_LT(nees / poses, 1.6) << blur; // 72 values: sigmas that hold stay below 1.35
      EXPECT_GT(nees / poses, 0.3) << blur;
      all += nees;
      frames += poses;
    }
    EXPECT_LT(all / frames, 1.3);
    EXPECT_GT(all / frames, 0.6);
  }
}

// Far away the corners leave two poses; the appearance of all faces decides between them.
TEST(RigPose, AllFacesResolveTheAmbiguityFarAway) {
  const struct {
    Camera camera;
    const char* family;
    double distance, blur;
    int most; // largest number of 40 frames without a pose
  } settings[] = {{test::smallCamera(), "apriltag_36h11", 0.9, 0.6, 4},
                  {test::smallCamera(), "4x4_50", 0.9, 1.2, 8},
                  {test::wideCamera(), "5x5_100", 0.6, 0.9, 4}};
  for (const auto& s : settings) {
    const RenderedRig rig(s.camera, s.family);
    std::mt19937 random(33);
    FrameLook look;
    look.blur = s.blur;
    int without = 0, of_corners = 0, wrong = 0;
    for (std::uint32_t i = 0; i < 40; ++i) {
      const Pose known = somePose(random, s.distance);
      const GreyFrame image = rig.renderer.render({known}, look, i);
      const auto markers = findMarkers(image, rig.books, &rig.camera);
      of_corners += poseOf(markers, rig.markers, rig.camera).verdict == RigVerdict::ambiguous;
      const SeenRig seen = poseOf(markers, rig.markers, rig.camera, nullptr, &image);
      without += seen.verdict != RigVerdict::seen;
      wrong += seen.verdict == RigVerdict::seen &&
               poseError(seen.camera_from_probe, known).tail<3>().norm() > 0.3;
    }
    std::printf("%s at %.1f m: %d of 40 without a pose, %d by corners alone, %d wrong\n", s.family,
                s.distance, without, of_corners, wrong);
    EXPECT_LE(without, s.most);
    EXPECT_LE(wrong, 1);
  }
}

// Exact corners without an image, for the tests below.
std::vector<SeenMarker> seenExactly(const RenderedRig& rig, const Pose& pose,
                                    const std::vector<std::size_t>& which, double noise = 0) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1);
  std::vector<SeenMarker> seen;
  for (const std::size_t i : which) {
    SeenMarker marker{rig.markers[i].family, rig.markers[i].id, 0, {}, 0};
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3 p = pose * rig.markers[i].corners()[c];
      FittedCorner& corner = marker.corner[c];
      corner.undistorted = {rig.camera.fx * p.x() / p.z() + rig.camera.cx,
                            rig.camera.fy * p.y() / p.z() + rig.camera.cy};
      corner.undistorted += noise * Vec2(normal(random), normal(random));
      corner.pixel = corner.undistorted;
      corner.whiten = 20 * Eigen::Matrix2d::Identity(); // 0.05 px
    }
    seen.push_back(marker);
  }
  return seen;
}

TEST(RigPose, IsExactWithoutNoise) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const Pose known = somePose(random, 0.4, 1);
    const SeenRig seen = poseOf(seenExactly(rig, known, {0, 1, 3}), rig.markers, rig.camera);
    ASSERT_EQ(seen.verdict, RigVerdict::seen);
    EXPECT_LT(poseError(seen.camera_from_probe, known).norm(), 1e-8);
    EXPECT_LT(seen.rms, 1e-6);
  }
}

TEST(RigPose, LastPoseResolvesTheAmbiguityOfOneMarkerFarAway) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  Pose known = Pose::Identity();
  known.translation() = Vec3(0.02, -0.01, 1.5);
  known.linear() = (Eigen::AngleAxisd(M_PI, Vec3::UnitX()) * Eigen::AngleAxisd(0.3, Vec3::UnitY()))
                       .toRotationMatrix();
  const auto corners = seenExactly(rig, known, {0}, 0.05);
  EXPECT_EQ(poseOf(corners, rig.markers, rig.camera).verdict, RigVerdict::ambiguous);
  Pose previous_pose = known;
  previous_pose.linear() =
      known.linear() * Eigen::AngleAxisd(0.05, Vec3::UnitX()).toRotationMatrix();
  const SeenRig seen = poseOf(corners, rig.markers, rig.camera, &previous_pose);
  ASSERT_EQ(seen.verdict, RigVerdict::seen);
  EXPECT_LT(poseError(seen.camera_from_probe, known).tail<3>().norm(), 0.15);
  // A second face resolves the ambiguity.
  EXPECT_EQ(poseOf(seenExactly(rig, known, {0, 3}, 0.05), rig.markers, rig.camera).verdict,
            RigVerdict::seen);
}

TEST(RigPose, IsFoundFromOneMarkerNearby) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(3);
  Pose known = somePose(random, 0.25);
  known.linear() = (Eigen::AngleAxisd(M_PI, Vec3::UnitX()) * Eigen::AngleAxisd(0.6, Vec3::UnitY()))
                       .toRotationMatrix();
  const SeenRig seen = poseOf(seenExactly(rig, known, {0}, 0.03), rig.markers, rig.camera);
  ASSERT_EQ(seen.verdict, RigVerdict::seen);
  EXPECT_EQ(seen.markers, 1u);
  EXPECT_LT((seen.camera_from_probe * kTip - known * kTip).norm(), 3e-3);
}

TEST(RigPose, DropsAMarkerThatContradictsTheOthers) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(3);
  const Pose known = somePose(random);
  auto corners = seenExactly(rig, known, {0, 1, 3}, 0.02);
  for (FittedCorner& corner : corners[1].corner) corner.undistorted += Vec2(30, -20);
  const SeenRig seen = poseOf(corners, rig.markers, rig.camera);
  ASSERT_EQ(seen.verdict, RigVerdict::seen);
  EXPECT_EQ(seen.dropped, 1u);
  EXPECT_LT((seen.camera_from_probe * kTip - known * kTip).norm(), 1e-3);
}

// Two poses of a flat rig fit far away, and a wrong marker must not hide the second one.
TEST(RigPose, DroppedMarkerLeavesTheTiltAmbiguous) {
  RenderedRig rig(test::smallCamera(), "4x4_50");
  const RigMarker first = rig.markers[0];
  rig.markers.clear();
  for (int i = 0; i < 6; ++i) {
    RigMarker marker = first;
    marker.id = i;
    marker.size = 0.03;
    marker.probe_from_marker = Pose::Identity();
    marker.probe_from_marker.translation() = Vec3(0.04 * (i % 3) - 0.04, 0.04 * (i / 3) - 0.02, 0);
    rig.markers.push_back(marker);
  }
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  int with = 0, wrong = 0, without = 0, wrong_without = 0;
  for (int i = 0; i < 1000; ++i) {
    Pose known = Pose::Identity();
    known.translation() = Vec3(0.1 * unit(random), 0.1 * unit(random), 1.2);
    known.linear() = (Eigen::AngleAxisd(M_PI + 0.4 * unit(random), Vec3::UnitX()) *
                      Eigen::AngleAxisd(0.4 * unit(random), Vec3::UnitY()))
                         .toRotationMatrix();
    auto seen = seenExactly(rig, known, {0, 1, 2, 3, 4, 5});
    for (SeenMarker& marker : seen)
      for (FittedCorner& corner : marker.corner) {
        corner.undistorted += 0.15 * Vec2(normal(random), normal(random));
        corner.whiten = 1 / 0.15 * Eigen::Matrix2d::Identity();
      }
    const auto turned = [&](const std::vector<SeenMarker>& of, int& told) {
      const SeenRig found = poseOf(of, rig.markers, rig.camera);
      if (found.verdict != RigVerdict::seen) return 0;
      ++told;
      return int{poseError(found.camera_from_probe, known).tail<3>().norm() > 0.2};
    };
    const auto five = std::vector<SeenMarker>(seen.begin() + 1, seen.end());
    for (FittedCorner& corner : seen[0].corner) corner.undistorted += Vec2(5, -4);
    wrong += turned(seen, with);
    wrong_without += turned(five, without);
  }
  std::printf("turned: %d of %d with a wrong marker, %d of %d without it\n", wrong, with,
              wrong_without, without);
  EXPECT_LE(wrong, wrong_without + 0.01 * with);
  EXPECT_GT(with, 0.9 * without);
}

TEST(RigPose, RefusesARigOfAnotherSize) {
  RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(3);
  const auto corners = seenExactly(rig, somePose(random), {0, 1, 3});
  for (RigMarker& marker : rig.markers) marker.size *= 0.7; // their positions stay
  EXPECT_EQ(poseOf(corners, rig.markers, rig.camera).verdict, RigVerdict::misfit);
}

TEST(RigPose, NeedsAMarkerOfTheRig) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  EXPECT_EQ(poseOf({}, rig.markers, rig.camera).verdict, RigVerdict::no_marker);
  std::mt19937 random(3);
  auto corners = seenExactly(rig, somePose(random), {0});
  corners.push_back(corners[0]); // the same marker twice cannot be
  EXPECT_EQ(poseOf(corners, rig.markers, rig.camera).verdict, RigVerdict::repeated);
}

TEST(RigPose, NamesBothPositionsOfAMarkerSeenTwice) {
  const RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(3);
  auto corners = seenExactly(rig, somePose(random), {0, 1, 3});
  SeenMarker twin = corners[0];
  Vec2 middle = Vec2::Zero();
  for (FittedCorner& corner : twin.corner) {
    middle += corner.pixel / 4;
    corner.pixel += Vec2(100, -20);
  }
  corners.push_back(twin);
  const SeenRig others = poseOf(corners, rig.markers, rig.camera);
  EXPECT_EQ(others.verdict, RigVerdict::seen);
  EXPECT_EQ(others.markers, 2u);
  ASSERT_EQ(others.repeated.size(), 1u);
  EXPECT_EQ(others.repeated[0].id, rig.markers[0].id);
  const auto& places = others.repeated[0].places;
  EXPECT_TRUE(places.at(0).isApprox(middle) && places.at(1).isApprox(middle + Vec2(100, -20)));
  const SeenRig alone = poseOf({corners[0], twin}, rig.markers, rig.camera);
  const RepeatedMarker marker{"4x4_50", 7, {Vec2(159.6, 239), Vec2(480, 241.2)}};
  EXPECT_EQ(textOf(marker), "marker 7 of 4x4_50 is seen twice, at (160, 239) and (480, 241) px");
  EXPECT_EQ(reasonOf(alone), textOf(alone.repeated[0]));
}

class Frames : public testing::Test {
 protected:
  Frames() : rig(test::smallCamera(), "4x4_50"), folder(test::freshFolder("frames")) {
    std::filesystem::create_directories(folder / "frames");
    std::mt19937 random(8);
    std::string list = "frame,t [s]\n";
    for (int i = 0; i < 4; ++i) {
      poses.push_back(somePose(random, 0.4, 0.5));
      writeGrey(fileOf(i), rig.renderer.render({poses.back()}, {}, 1));
      list += std::to_string(i) + "," + std::to_string(0.5 * i) + "\n";
    }
    writeFileAtomically(folder / "frames.csv", list);
  }
  ~Frames() override { std::filesystem::remove_all(folder); }
  std::filesystem::path fileOf(int i) const {
    return folder / "frames" / ("00000" + std::to_string(i) + ".png");
  }
  TrackedFrames tracked(const Camera& camera) const {
    Progress progress;
    return trackFrames(*openFrames(folder.string(), 0), camera, rig.markers, {}, progress);
  }

  RenderedRig rig;
  std::filesystem::path folder;
  std::vector<Pose> poses;
};

TEST_F(Frames, BecomePosesAtTheirTimes) {
  const TrackedFrames found = tracked(rig.camera);
  ASSERT_EQ(found.poses.size(), 4u);
  EXPECT_LT(found.rms, 0.1);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found.poses[i].t, 0.5 * static_cast<double>(i));
    EXPECT_LT((found.poses[i].position - poses[i].translation()).norm(), 1e-3);
    EXPECT_GT(found.poses[i].sigma_position, 1e-6);
  }
}

TEST_F(Frames, AreGapsWithAReasonIfMissingUnreadableOrEmpty) {
  std::filesystem::remove(fileOf(0));
  writeFileAtomically(fileOf(1), "no picture");
  writeGrey(fileOf(2), {640, 480, std::vector<std::uint8_t>(640 * 480, 100)});
  const TrackedFrames found = tracked(rig.camera);
  ASSERT_EQ(found.poses.size(), 1u);
  ASSERT_EQ(found.without.size(), 3u);
  EXPECT_EQ(found.unreadable, 2u);
  EXPECT_NE(found.without[0].why.find("000000.png: does not exist"), std::string::npos);
  EXPECT_NE(found.without[1].why.find("000001.png: cannot be read"), std::string::npos);
  EXPECT_EQ(found.without[2].why, "no marker of the rig");
  // The file marks them, and reading ignores the marks.
  writePoses(folder / "poses.tum", found.poses, found.without);
  EXPECT_NE(readFile(folder / "poses.tum").find("# 1 no pose: no marker"), std::string::npos);
  const auto back = readPoses(folder / "poses.tum");
  ASSERT_EQ(back.values.size(), 1u);
  EXPECT_EQ(back.values[0].sigma_position, found.poses[0].sigma_position);
}

TEST_F(Frames, NameBothPositionsOfAMarkerShownTwice) {
  GreyFrame image = rig.renderer.render({poses[0]}, {}, 1);
  const auto seen = findMarkers(image, rig.books, &rig.camera);
  rig.markers = {rig.markers.at(static_cast<std::size_t>(seen.at(0).id))};
  // The middle half of the picture appears on both sides.
  const auto whole = image.pixel;
  for (std::size_t i = 0; i < whole.size(); ++i)
    image.pixel[i] = whole[i - i % 640 + 160 + i % 320];
  writeGrey(fileOf(0), image);
  const TrackedFrames found = tracked(rig.camera);
  ASSERT_EQ(found.repeated, 1u);
  EXPECT_EQ(found.first_repeated, "at 0 s " + found.without[0].why);
  EXPECT_NE(found.without[0].why.find(" of 4x4_50 is seen twice, at ("), std::string::npos);
}

TEST_F(Frames, AreRejectedIfTheirSizeDiffersFromTheCalibration) {
  try {
    (void)tracked(test::largeCamera());
    FAIL();
  } catch (const FileError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("000000.png: is 640 x 480"), std::string::npos) << what;
    EXPECT_NE(what.find("1920 x 1080"), std::string::npos) << what;
  }
}

TEST_F(Frames, NeedTheirTimes) {
  writeFileAtomically(folder / "frames.csv", "frame,t [s]\n0,1\n1,0.5\n");
  EXPECT_THROW((void)framesOf(folder, 0), FileError);
  std::filesystem::remove(folder / "frames.csv");
  EXPECT_THROW((void)framesOf(folder, 0), FileError);
  EXPECT_EQ(framesOf(folder, 30).size(), 4u);
  EXPECT_THROW((void)framesOf(folder / "none", 30), FileError);
}

TEST(RigTracker, NamesAnIdThatItsFamilyDoesNotHave) {
  RigMarker marker{"4x4_50", 50, 0.03, Pose::Identity()};
  EXPECT_THROW(RigTracker(test::smallCamera(), {marker}), Error);
}

} // namespace
} // namespace patina
