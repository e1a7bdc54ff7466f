#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquisition/calibration/board.h"
#include "acquisition/calibration/calibrate_camera.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/loaded/vision_library.h"
#include "acquisition/simulation/simulated_pivot.h"
#include "acquisition/tracking/lens.h"
#include "core/decompose.h"
#include "core/error.h"
#include "support/oriented_pictures.h"
#include "support/printed_board.h"
#include "support/rendered_rig.h"
#include "support/shared_data.h"

namespace patina {
namespace {

TEST(Pivot, FindsTheTipToATenthOfAMillimetreAmongOutliers) {
  const SimulatedPivot pivot; // 200 poses, 45 degrees, 0.3 mm, 0.3 degrees, 10 % of 15 mm
  std::vector<double> errors;
  double nees = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const auto fit = fitPivot(simulatePivot(pivot, seed));
    ASSERT_TRUE(fit);
    const Vec3 off = fit->tip - pivot.tip;
    errors.push_back(off.norm());
    nees += off.dot(SymmetricSolver(fit->covariance).solve(off)) / 300;
    EXPECT_GE(fit->rejected, 8u);
    EXPECT_LE(fit->rejected, 40u);
  }
  std::sort(errors.begin(), errors.end());
  std::printf("median %.4f mm, NEES %.2f\n", 1e3 * errors[50], nees);
  EXPECT_LE(errors[50], 0.12e-3);
  EXPECT_NEAR(nees, 1, 0.35);
}

TEST(Pivot, IsExactWithoutNoise) {
  SimulatedPivot pivot;
  pivot.tip = Vec3(0.01, -0.03, -0.15);
  pivot.outliers = 0;
  pivot.sigma_position = pivot.sigma_angle = 1e-12;
  const auto fit = fitPivot(simulatePivot(pivot, 3));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->tip - pivot.tip).norm(), 1e-9);
  EXPECT_LT((fit->point - pivot.point).norm(), 1e-9);
}

// Angle errors must not shorten the arm of a probe that rotated little.
TEST(Pivot, ArmIsNotShortenedBySmallRotations) {
  for (const double degrees : {9., 14., 34.}) {
    SimulatedPivot pivot;
    pivot.cone = degrees * M_PI / 180;
    pivot.sigma_position = 0.2e-3;
    pivot.sigma_angle = 0.27 * M_PI / 180;
    pivot.outliers = 0;
    double mean = 0, nees = 0;
    constexpr int kSeeds = 60;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const auto fit = fitPivot(simulatePivot(pivot, seed));
      ASSERT_TRUE(fit);
      const Vec3 off = fit->tip - pivot.tip;
      mean += off.z() / kSeeds;
      nees += off.dot(SymmetricSolver(fit->covariance).solve(off)) / (3 * kSeeds);
    }
    std::printf("cone of %.0f degrees: %.3f mm too short, NEES %.2f\n", degrees, 1e3 * mean, nees);
    EXPECT_NEAR(mean, 0, 0.15e-3);
    EXPECT_NEAR(nees, 1, 0.6);
  }
}

TEST(Pivot, ReturnsNothingIfTheProbeHardlyRotates) {
  SimulatedPivot pivot;
  pivot.cone = 0.001;
  EXPECT_FALSE(fitPivot(simulatePivot(pivot, 3)));
  pivot.cone = 0.5;
  pivot.poses = 9;
  EXPECT_FALSE(fitPivot(simulatePivot(pivot, 3)));
  EXPECT_FALSE(fitPivot({}));
}

TEST(Board, IsParsedFromItsTextOrRejected) {
  const Board chess = parseBoard("chessboard:9x6:25mm");
  EXPECT_EQ(chess.columns, 9);
  EXPECT_EQ(chess.rows, 6);
  EXPECT_DOUBLE_EQ(chess.square, 0.025);
  EXPECT_TRUE(chess.family.empty());
  EXPECT_EQ(parseBoard("charuco:5x7:40mm:20mm:6x6_250").family, "6x6_250");
  for (const char* wrong :
       {"", "chessboard", "chessboard:9:25mm", "chessboard:9x6:-1mm", "chessboard:9x1:25mm",
        "charuco:5x7:20mm:40mm:6x6_250", "charuco:5x7:40mm:20mm", "chessboard:9x6:25mm:1mm"})
    EXPECT_THROW((void)parseBoard(wrong), Error) << wrong;
}

TEST(Board, CornersAreFoundWhereTheyAreRendered) {
  // Markers wide enough for their margins to fill the white squares.
  const Board board = parseBoard("charuco:5x7:30mm:22.5mm:4x4_50");
  const std::vector<PrintedMarker> printed = test::printedBoard(board);
  const Camera camera = test::largeCamera();
  const FrameRenderer renderer(camera, printed);
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(M_PI, Vec3::UnitX()) * Eigen::AngleAxisd(0.3, Vec3::UnitY()))
                      .toRotationMatrix();
  pose.translation() = Vec3(-0.07, -0.1, 0.5);
  FrameLook look;
  look.ground = look.white;
  const auto view = findBoard(renderer.render({pose}, look, 1), board);
  ASSERT_TRUE(view);
  double squares = 0;
  for (std::size_t i = 0; i < view->board.size(); ++i)
    squares +=
        (view->pixel[i] - pixelOf(camera, pose * Vec3(view->board[i].x(), -view->board[i].y(), 0)))
            .squaredNorm() /
        static_cast<double>(view->board.size());
  std::printf("%zu corners, %.3f px\n", view->board.size(), std::sqrt(squares));
  EXPECT_GE(view->board.size(), 20u);
  EXPECT_LT(std::sqrt(squares), 0.1);
}

// Its squares are markers without codes.
TEST(Board, FastSearchIsAsPreciseAsTheSlowOne) {
  const Board board = parseBoard("chessboard:9x6:25mm");
  std::vector<PrintedMarker> printed;
  for (int y = 0; y < 7; ++y)
    for (int x = y % 2; x < 10; x += 2) {
      PrintedMarker one{{"4x4_50", 0, 0.025, Pose::Identity()}, 4, 0, 0};
      one.place.probe_from_marker.translation() = 0.025 * Vec3(x + 0.5, -(y + 0.5), 0);
      printed.push_back(one);
    }
  std::mt19937 random(5);
  const Pose pose = test::boardPose(board, random, 0.4);
  const GreyFrame image =
      FrameRenderer(test::largeCamera(), printed).render({pose}, test::boardLook(), 1);
  const auto view = findBoard(image, board), quick = findBoard(image, board, true);
  ASSERT_TRUE(view && quick);
  ASSERT_EQ(quick->pixel.size(), 54u);
  for (std::size_t i = 0; i < 54; ++i)
    EXPECT_LT((quick->pixel[i] - view->pixel[i]).norm(), 1e-3) << i;
}

TEST(Calibration, IsNoWorseThanOpenCvOnTheSharedChessboard) {
  const Board board = parseBoard("chessboard:9x6:25mm");
  CameraFit fit;
  std::vector<BoardView> views;
  for (int i = 1; i <= 9; ++i) {
    const auto path = test::sharedData("camera/left0" + std::to_string(i) + ".jpg");
    PATINA_SKIP_WITHOUT(path);
    const GreyFrame image = readGrey(path);
    fit.camera.width = image.width;
    fit.camera.height = image.height;
    const auto view = findBoard(image, board);
    ASSERT_TRUE(view) << i;
    EXPECT_EQ(view->board.size(), 54u);
    views.push_back(*view);
  }
  ASSERT_EQ(visionLibrary().calibrate(views, fit), "");
  std::printf("rms %.4f px, fx %.2f +- %.2f\n", fit.rms, fit.camera.fx, fit.deviation[0]);
  EXPECT_LE(fit.rms, 0.20);
  EXPECT_NEAR(fit.camera.fx, 536, 10);
}

// Corners seen by a known camera, with noise; the counterpart on our own data.
TEST(Calibration, FindsAKnownCameraWithinItsDeviations) {
  const Camera known = test::smallCamera();
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<BoardView> views;
  for (int i = 0; i < 15; ++i) {
    Pose pose = Pose::Identity();
    const double a = unit(random), b = unit(random), c = unit(random);
    pose.linear() =
        (Eigen::AngleAxisd(0.6 * a, Vec3::UnitX()) * Eigen::AngleAxisd(0.6 * b, Vec3::UnitY()))
            .toRotationMatrix();
    pose.translation() = Vec3(-0.1 + 0.05 * a, -0.06 + 0.04 * b, 0.35 + 0.05 * c);
    BoardView view;
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 9; ++x) {
        const Vec2 place = 0.025 * Vec2(x, y);
        view.board.push_back(place);
        const double u = noise(random), v = noise(random);
        view.pixel.push_back(pixelOf(known, pose * Vec3(place.x(), place.y(), 0)) + Vec2(u, v));
      }
    views.push_back(view);
  }
  CameraFit fit;
  fit.camera.width = known.width;
  fit.camera.height = known.height;
  ASSERT_EQ(visionLibrary().calibrate(views, fit), "");
  EXPECT_NEAR(fit.rms, 0.1 * std::sqrt(2), 0.02);
  const double errors[] = {fit.camera.fx - known.fx, fit.camera.fy - known.fy,
                           fit.camera.cx - known.cx, fit.camera.cy - known.cy};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(std::abs(errors[i]), 4 * fit.deviation[i]);
    EXPECT_GT(fit.deviation[i], 0.01);
  }
}

// Views of a board from a live camera, a video or pictures.
class BoardFrames : public FrameSource {
 public:
  BoardFrames(std::vector<GreyFrame> images, double step, bool pictures)
      : images_(std::move(images)), step_(step), pictures_(pictures) {}
  std::optional<SourceFrame> next() override {
    if (at_ == images_.size()) return std::nullopt;
    const double t = step_ * static_cast<double>(at_);
    const std::string name = "frame " + std::to_string(at_);
    return SourceFrame{t, name, images_[at_++], {}};
  }
  std::optional<std::size_t> count() const override { return images_.size(); }
  bool isLive() const override { return false; }
  void stop() noexcept override {}
  bool arePictures() const override { return pictures_; }

 private:
  std::vector<GreyFrame> images_;
  double step_;
  bool pictures_;
  std::size_t at_ = 0;
};

class Boards : public testing::Test {
 protected:
  CalibratedCamera calibrated(std::vector<GreyFrame> images, bool pictures = true) const {
    BoardFrames frames(std::move(images), 1 / 30., pictures);
    Progress progress;
    return fitCameraToFrames(frames, board, "the board", "views", progress);
  }
  std::vector<GreyFrame> views(int count, bool white_first, double blur = 0.6) const {
    const FrameRenderer renderer(camera, test::printedBoard(board, white_first));
    FrameLook look = test::boardLook();
    look.blur = blur;
    std::mt19937 random(4);
    std::vector<GreyFrame> images;
    for (int i = 0; i < count; ++i)
      images.push_back(renderer.render({test::boardPose(board, random, 0.35)}, look, 1));
    return images;
  }

  Board board = parseBoard("charuco:6x8:25mm:18.75mm:4x4_50");
  Camera camera = test::smallCamera();
};

TEST_F(Boards, CalibrateEquallyInBothLayouts) {
  for (const bool white_first : {false, true}) {
    const CalibratedCamera found = calibrated(views(10, white_first));
    std::printf("rms %.3f px, fx %.2f +- %.2f\n", found.fit.rms, found.fit.camera.fx,
                found.fit.deviation[0]);
    EXPECT_EQ(found.views, 10u);
    EXPECT_EQ(found.doubt, "");
    EXPECT_LT(found.fit.rms, 0.2);
    EXPECT_NEAR(found.fit.camera.fx, camera.fx, 4 * found.fit.deviation[0] + 1);
  }
}

TEST_F(Boards, WarnIfTheNumberOfSquaresDiffers) {
  const auto images = views(6, false);
  board = parseBoard("charuco:7x8:25mm:18.75mm:4x4_50");
  const CalibratedCamera found = calibrated(images);
  std::printf("rms %.1f px\n", found.fit.rms);
  EXPECT_NE(found.doubt.find("views: corners miss by "), std::string::npos) << found.doubt;
  EXPECT_NE(found.doubt.find("the number of its squares"), std::string::npos) << found.doubt;
}

// Some pictures are rotated because the camera was held upright; the pixels are the same.
TEST_F(Boards, CalibrateOneCameraFromRotatedPictures) {
  std::vector<GreyFrame> images = views(10, false);
  const CalibratedCamera before = calibrated(images);
  for (const std::size_t i : {1u, 4u, 7u}) images[i] = turned(images[i], i == 4 ? 3 : 6);
  const CalibratedCamera found = calibrated(images);
  EXPECT_NEAR(found.fit.camera.cx, before.fit.camera.cx, 0.5);
  EXPECT_NEAR(found.fit.camera.cy, before.fit.camera.cy, 0.5);
  EXPECT_LT(found.fit.rms, before.fit.rms + 0.05);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("the camera was turned between pictures"), std::string::npos)
      << found.notes[0];
  // Half turns keep the picture size, so only the fit can detect them.
  images = views(10, false);
  for (const std::size_t i : {1u, 4u, 7u}) images[i] = turned(images[i], 3);
  EXPECT_NEAR(calibrated(images).fit.camera.cx, before.fit.camera.cx, 0.5);
  // Files stored in several orientations belong to one camera as they are displayed.
  images = views(10, false);
  for (const std::size_t i : {1u, 4u, 7u}) images[i].orientation = 3;
  EXPECT_NEAR(calibrated(images).fit.camera.cx, before.fit.camera.cx, 0.5);
}

// Thirty poses of ten frames each, of which three are blurred.
TEST_F(Boards, VideoFramesAreChosenSharpAndApart) {
  const auto sharp = views(30, true), blurred = views(30, true, 3);
  std::vector<GreyFrame> images;
  for (std::size_t i = 0; i < 30; ++i)
    for (int k = 0; k < 10; ++k) images.push_back(k % 3 == 2 ? blurred[i] : sharp[i]);
  const CalibratedCamera found = calibrated(images, false);
  std::printf("%zu of %zu, rms %.3f px, fx %.2f +- %.2f\n", found.views, found.frames,
              found.fit.rms, found.fit.camera.fx, found.fit.deviation[0]);
  EXPECT_EQ(found.frames, 300u);
  EXPECT_GE(found.views, 25u);
  EXPECT_LE(found.views, 30u);
  EXPECT_LT(found.fit.rms, 0.2);
  EXPECT_NEAR(found.fit.camera.fx, camera.fx, 4 * found.fit.deviation[0] + 1);
}

TEST_F(Boards, GiveNoCameraIfTheyHardlyMoveInAVideo) {
  const std::vector<GreyFrame> images(20, views(1, false)[0]);
  try {
    (void)calibrated(images, false);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(
        std::string(error.what())
            .find("is seen in 20 of 20 views, of which 1 are sharp and differ; three at least"),
        std::string::npos)
        << error.what();
  }
}

TEST(Views, AreChosenFarApartAndNoMoreThanRequested) {
  std::vector<ViewChoice> views;
  for (int i = 0; i < 100; ++i) {
    const Vec2 at(5 * i, 0);
    views.push_back({{at, at + Vec2(100, 0), at + Vec2(100, 80), at + Vec2(0, 80)},
                     i % 2 ? 5.0 : 1.0,
                     0.1 * i});
  }
  const auto two = chooseViews(views, 800, 2);
  EXPECT_EQ(two, (std::vector<std::size_t>{0, 98}));
  const auto all = chooseViews(views, 800, 60);
  EXPECT_EQ(all.size(), 50u); // the sharp ones
  for (const std::size_t i : all) EXPECT_EQ(i % 2, 0u);
  EXPECT_EQ(chooseViews(views, 800, 10).size(), 10u);
  EXPECT_TRUE(chooseViews({}, 800, 10).empty());
}

} // namespace
} // namespace patina
