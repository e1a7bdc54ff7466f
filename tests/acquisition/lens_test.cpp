// Lens models against OpenCV's projection, their derivatives against differences.
#include "acquisition/tracking/lens.h"

#include <gtest/gtest.h>

#include <random>

#include "support/opencv_projection.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

std::vector<Camera> cameraModels() {
  std::vector<Camera> all = {test::smallCamera(),    test::largeCamera(),  test::wideCamera(),
                             test::rationalCamera(), test::tiltedCamera(), test::fisheyeCamera()};
  Camera prism = test::smallCamera();
  prism.distortion[8] = 0.01, prism.distortion[9] = -2e-3;
  prism.distortion[10] = -0.02, prism.distortion[11] = 3e-3;
  all.push_back(prism);
  Camera equidistant = test::fisheyeCamera();
  equidistant.distortion = {};
  all.push_back(equidistant);
  Camera pinhole = test::smallCamera();
  pinhole.distortion = {};
  all.push_back(pinhole);
  // Real calibrations of a telephone, an Azure Kinect and a T265.
  all.push_back({1920, 1080, 1412.3, 1411.8, 962.1, 541.7, {0.124, -0.257, 8e-4, -3e-4, 0.142}});
  all.push_back({1280, 720, 608, 608, 640, 366, {0.52, -2.7, 1e-3, -3e-4, 1.56, 0.4, -2.52, 1.49}});
  Camera t265{848, 800, 286.3, 286.4, 425.1, 399.8, {-0.0083, 0.0447, -0.0424, 0.0080}};
  t265.lens = LensModel::fisheye;
  all.push_back(t265);
  return all;
}

TEST(Lens, SeesPointsWhereOpenCvDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const Camera& camera : cameraModels())
    for (int i = 0; i < 200; ++i) {
      const Vec2 pixel(unit(random) * camera.width, unit(random) * camera.height);
      const auto flat = normalizedPoint(camera, pixel);
      if (!flat) continue; // behind the lens, or beyond 89 degrees
      const Vec3 point = (0.3 + unit(random)) * flat->homogeneous();
      EXPECT_LT((pixelOf(camera, point) - test::projectedByOpenCv(camera, point)).norm(), 1e-9);
    }
}

TEST(Lens, IsInvertedToTenDigitsOverThePicture) {
  for (const Camera& camera : cameraModels()) {
    int seen = 0;
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20; ++j) {
        const Vec2 pixel(0.05 * i * (camera.width - 1), 0.05 * j * (camera.height - 1));
        const auto flat = normalizedPoint(camera, pixel);
        if (!flat) continue;
        ++seen;
        const Vec2 back = test::projectedByOpenCv(camera, flat->homogeneous());
        EXPECT_LT((back - pixel).norm() / camera.fx, 1e-10);
        const auto straight = undistortedPoint(camera, pixel);
        ASSERT_TRUE(straight);
        EXPECT_LT((distortedPoint(camera, *straight) - pixel).norm() / camera.fx, 1e-10);
      }
    // A lens of more than 178 degrees has corners that no plane contains.
    EXPECT_GE(seen, camera.width == 848 ? 300 : 441);
  }
}

TEST(Lens, HasTheDerivativeOfItsMap) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Camera& camera : cameraModels())
    for (int i = 0; i < 100; ++i) {
      const double reach = camera.lens == LensModel::fisheye ? 3 : 0.5;
      const Vec2 flat = reach * Vec2(unit(random), unit(random));
      const DistortedPoint point = distortedWithJacobian(camera, flat);
      EXPECT_EQ(point.place, distorted(camera, flat));
      constexpr double kDifference = 1e-5;
      for (int k = 0; k < 2; ++k) {
        const Vec2 step = kDifference * Vec2::Unit(k);
        const Vec2 slope =
            (distorted(camera, flat + step) - distorted(camera, flat - step)) / (2 * kDifference);
        EXPECT_LT((point.jacobian.col(k) - slope).norm(), 1e-8);
      }
    }
  const Camera fisheye = test::fisheyeCamera();
  EXPECT_TRUE(distortedWithJacobian(fisheye, Vec2::Zero()).jacobian.isIdentity(1e-15));
}

TEST(Lens, ProjectsNothingWhereItFoldsOrLooksSideways) {
  Camera folds = test::smallCamera();
  folds.distortion = {-0.5, 0, 0, 0, 0};
  folds.fx = folds.fy = 200;
  EXPECT_TRUE(normalizedPoint(folds, {folds.cx + 50, folds.cy}));
  EXPECT_FALSE(normalizedPoint(folds, {0, 0}));
  Camera wide = test::fisheyeCamera();
  wide.distortion = {};
  for (const double degrees : {1., 45., 80., 88., 88.9}) {
    const double angle = degrees * M_PI / 180;
    const auto flat = normalizedPoint(wide, {wide.cx, wide.cy + wide.fy * angle});
    ASSERT_TRUE(flat) << degrees;
    EXPECT_NEAR(std::atan(flat->y()), angle, 1e-10);
  }
  for (const double degrees : {89.1, 90., 100., 170.})
    EXPECT_FALSE(normalizedPoint(wide, {wide.cx, wide.cy + wide.fy * degrees * M_PI / 180}))
        << degrees;
}

} // namespace
} // namespace patina
