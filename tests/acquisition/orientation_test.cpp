#include "acquisition/values/orientation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/recording/recorder.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/track_frames.h"
#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/oriented_pictures.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// Returns the displayed position of the stored `point`, as pixel coordinates; mirroring included.
Vec3 shownPoint(const Vec3& point, int orientation) {
  const GreyFrame none{1, 1, {}, orientation};
  Vec3 shown = point;
  shown.head<2>() = shownPixel(point.head<2>(), none);
  return shown;
}

TEST(Orientation, CameraIsRotatedLikeItsPictures) {
  Camera tilted = test::tiltedCamera(), tilted_y = test::tiltedCamera();
  tilted.distortion[13] = 0;
  tilted_y.distortion[12] = 0;
  for (const Camera& camera : {test::smallCamera(), test::wideCamera(), test::rationalCamera(),
                               test::fisheyeCamera(), tilted, tilted_y})
    for (int orientation = 1; orientation <= 8; ++orientation) {
      const Camera shown = turned(camera, orientation);
      const GreyFrame picture{shown.width, shown.height, {}, orientation};
      for (const Vec3& point : {Vec3(0.2, 0.1, 1), Vec3(-0.3, 0.25, 1.2), Vec3(0.1, -0.3, 0.9)}) {
        const Vec2 stored = pixelOf(camera, point);
        const Vec2 seen = pixelOf(shown, shownPoint(point, orientation));
        EXPECT_LT((seen - shownPixel(stored, picture)).norm(), 1e-9) << orientation;
        EXPECT_LT((storedPixel(seen, picture) - stored).norm(), 1e-9) << orientation;
      }
    }
}

TEST(Orientation, IsRejectedIfATiltAboutTwoAxesIsAmbiguous) {
  EXPECT_NO_THROW((void)turned(test::tiltedCamera(), 3));
  EXPECT_THROW((void)turned(test::tiltedCamera(), 6), Error);
}

class OrientedFrames : public testing::Test {
 protected:
  OrientedFrames() : rig(test::smallCamera(), "4x4_50"), folder(test::freshFolder("oriented")) {
    std::mt19937 random(8);
    for (int i = 0; i < 3; ++i)
      images.push_back(rig.renderer.render({test::somePose(random, 0.4, 0.5)}, {}, 1));
  }
  ~OrientedFrames() override { fs::remove_all(folder); }
  template <class Write> void store(int orientation, const Write& write) const {
    fs::remove_all(folder);
    fs::create_directories(folder);
    for (std::size_t i = 0; i < images.size(); ++i)
      write(folder / ("IMG_" + std::to_string(i)), test::storedAs(images[i], orientation),
            orientation);
  }
  TrackedFrames tracked(const Camera& camera) const {
    Progress progress;
    return trackFrames(*openFrames(folder.string(), 30), camera, rig.markers, {}, progress);
  }
  // Largest difference from the poses of the upright pictures [m or rad].
  static double apart(const TrackedFrames& a, const TrackedFrames& b) {
    EXPECT_EQ(a.poses.size(), 3u);
    EXPECT_EQ(b.poses.size(), 3u);
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.poses.size(), b.poses.size()); ++i)
      most = std::max({most, (a.poses[i].position - b.poses[i].position).norm(),
                       a.poses[i].orientation.angularDistance(b.poses[i].orientation)});
    return most;
  }
  // The camera of the stored pictures, which become those of rig.camera when rotated.
  Camera storedCamera(int orientation) const {
    return turned(rig.camera, orientation == 6 ? 8 : orientation == 8 ? 6 : orientation);
  }

  test::RenderedRig rig;
  fs::path folder;
  std::vector<GreyFrame> images;
};

TEST_F(OrientedFrames, GiveThePosesOfUprightOnes) {
  store(1, test::writeTiff);
  const TrackedFrames upright = tracked(rig.camera);
  EXPECT_TRUE(upright.notes.empty());
  double most = 0;
  for (int orientation = 2; orientation <= 8; ++orientation) {
    store(orientation, test::writeTiff);
    EXPECT_EQ(readGrey(folder / "IMG_1").pixel, images[1].pixel) << orientation;
    const TrackedFrames shown = tracked(rig.camera);
    most = std::max(most, apart(shown, upright));
    ASSERT_EQ(shown.notes.size(), 1u);
    EXPECT_NE(shown.notes[0].find("IMG_0: is turned as viewers show it, by its orientation " +
                                  std::to_string(orientation) + "; so are 3 of 3"),
              std::string::npos)
        << shown.notes[0];
    if (!isTransposed(orientation)) continue;
    const TrackedFrames along = tracked(storedCamera(orientation));
    most = std::max(most, apart(along, upright));
    ASSERT_EQ(along.notes.size(), 1u);
    EXPECT_NE(along.notes[0].find("calibrated at 480 x 640 unturned, is turned along"),
              std::string::npos)
        << along.notes[0];
  }
  std::printf("poses differ by %.2g at most\n", most);
  EXPECT_LT(most, 1e-6);
}

// Each orientation is compressed separately, which moves corners a little.
TEST_F(OrientedFrames, DifferOnlyByCompressionInJpegFiles) {
  store(1, test::writeJpeg);
  const TrackedFrames upright = tracked(rig.camera);
  double most = 0;
  for (const int orientation : {3, 6, 7, 8}) {
    store(orientation, test::writeJpeg);
    most = std::max(most, apart(tracked(rig.camera), upright));
    if (isTransposed(orientation))
      most = std::max(most, apart(tracked(storedCamera(orientation)), upright));
  }
  std::printf("poses differ by %.2g at most\n", most);
  EXPECT_LT(most, 0.01);
}

TEST_F(OrientedFrames, AreRecordedAsShownWithTheirCamera) {
  store(6, test::writeTiff);
  const TrackedFrames shown = tracked(rig.camera);
  const fs::path made = test::freshFolder("recorded"), known = test::freshFolder("known");
  writeFileAtomically(known / "camera.yml", cameraText(storedCamera(6)));
  writeFileAtomically(known / "rig.json", rigText({}, rig.markers));
  RecordingSetup setup;
  setup.folder = made / "scan";
  setup.camera = known / "camera.yml";
  setup.rig = known / "rig.json";
  {
    Recorder recorder(openFrames(folder.string(), 30), nullptr, setup);
    while (recorder.poll().state.running) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const RecordingState state = recorder.poll().state;
    EXPECT_EQ(state.error, "");
    ASSERT_EQ(state.notes.size(), 1u);
    EXPECT_NE(state.notes[0].find("is turned along"), std::string::npos) << state.notes[0];
  }
  const Camera camera = readCamera(setup.folder / "camera.yml");
  EXPECT_NEAR(camera.cx, rig.camera.cx, 1e-9);
  EXPECT_NEAR(camera.distortion[2], rig.camera.distortion[2], 1e-12);
  Progress progress;
  const TrackedFrames again =
      trackFrames(*openFrames(setup.folder.string(), 0), camera, rig.markers, {}, progress);
  EXPECT_LT(apart(again, shown), 1e-6);
  fs::remove_all(made);
  fs::remove_all(known);
}

TEST_F(OrientedFrames, ReportDifferentOrientations) {
  store(1, test::writeTiff);
  test::writeTiff(folder / "IMG_2", test::storedAs(images[2], 3), 3);
  const TrackedFrames found = tracked(rig.camera);
  EXPECT_EQ(found.poses.size(), 3u);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("not all have one orientation (the first has 1, "),
            std::string::npos)
      << found.notes[0];
  // Another size is another camera.
  test::writeTiff(folder / "IMG_2", test::storedAs(images[2], 1), 6);
  try {
    (void)tracked(rig.camera);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("IMG_2: is 480 x 640 (turned by its orientation 6)"),
              std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace patina
