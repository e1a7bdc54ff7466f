#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquisition/calibration/board.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/simulation/simulated_pivot.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/vision_library.h"
#include "core/decompose.h"
#include "core/error.h"
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

// Errors of the angle must not shorten the arm of a probe that turned little.
TEST(Pivot, IsNoShorterWhereTheProbeTurnedLittle) {
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

TEST(Pivot, SaysNothingOfAProbeThatHardlyTurned) {
  SimulatedPivot pivot;
  pivot.cone = 0.001;
  EXPECT_FALSE(fitPivot(simulatePivot(pivot, 3)));
  pivot.cone = 0.5;
  pivot.poses = 9;
  EXPECT_FALSE(fitPivot(simulatePivot(pivot, 3)));
  EXPECT_FALSE(fitPivot({}));
}

TEST(Board, IsReadFromItsWordsOrRefused) {
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

// A ChArUco board as printed markers: its white squares carry codes, its black ones are markers
// without any.
std::vector<PrintedMarker> printedBoard(const Board& board) {
  const MarkerFamily& family = markerFamily(board.family);
  std::vector<PrintedMarker> printed;
  int id = 0;
  for (int y = 0; y < board.rows; ++y)
    for (int x = 0; x < board.columns; ++x) {
      PrintedMarker one{{board.family, 0, board.square, Pose::Identity()}, family.side, 0};
      one.place.probe_from_marker.translation() = board.square * Vec3(x + 0.5, -(y + 0.5), 0);
      if ((x + y) % 2) {
        one.code = family.code[static_cast<std::size_t>(id++)];
        one.place.size = board.marker;
      } else {
        one.margin = 0;
      }
      printed.push_back(one);
    }
  return printed;
}

TEST(Board, CornersAreFoundWhereTheyAreRendered) {
  // Markers wide enough for their margins to fill the white squares.
  const Board board = parseBoard("charuco:5x7:30mm:22.5mm:4x4_50");
  std::vector<PrintedMarker> printed = printedBoard(board);
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

TEST(Calibration, OfTheSharedChessboardIsNoWorseThanOpenCvs) {
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

// Corners that a known camera sees, with noise: its twin on our own data.
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

} // namespace
} // namespace patina
