// Tests the renderer of the tracking tests and studies against OpenCV's camera.
#include "acquisition/simulation/simulated_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/opencv_projection.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

const Camera kCameras[] = {test::smallCamera(), test::largeCamera(), test::wideCamera(),
                           test::rationalCamera(), test::fisheyeCamera()};

// The centroid of the dark pixels of a tile without white bits, against the mean of its points.
TEST(FrameRenderer, PutsTilesWhereOpenCvProjectsThem) {
  for (const Camera& camera : kCameras)
    for (const Vec2& aside : {Vec2(0, 0), Vec2(-0.7, 0.6), Vec2(0.75, 0.7), Vec2(0.1, -0.8)}) {
      PrintedMarker tile{{"", 0, 0.0123, Pose::Identity()}, 4, 0};
      Pose pose = Pose::Identity();
      const Vec2 edge(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy);
      pose.translation() = 0.5 * Vec3(aside.x() * edge.x(), aside.y() * edge.y(), 1);
      pose.linear() = (Eigen::AngleAxisd(M_PI, Vec3::UnitX()) *
                       Eigen::AngleAxisd(0.4, Vec3(1, 2, 0.5).normalized()))
                          .toRotationMatrix();
      FrameLook look;
      look.ground = look.white;
      look.shade = look.slope_shade = look.noise = look.waves = 0;
      const GreyFrame image = FrameRenderer(camera, {tile}).render({pose}, look, 1);
      const double white = std::lround(255 * look.white);
      double dark = 0;
      Vec2 middle = Vec2::Zero(), known = Vec2::Zero();
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const double d = white - image.row(y)[x];
          dark += d;
          middle += d * Vec2(x, y);
        }
      // The sum is over small cells of the tile, each weighted by its area in the picture.
      constexpr int kCells = 16;
      const auto node = [&](int i, int j) {
        return test::projectedByOpenCv(camera,
                                       pose * Vec3(tile.place.size * (1. * i / kCells - 0.5),
                                                   tile.place.size * (1. * j / kCells - 0.5), 0));
      };
      double area = 0;
      for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j) {
          const Vec2 p = node(i, j), q = node(i + 1, j), r = node(i + 1, j + 1), s = node(i, j + 1);
          const double cell = std::abs(cross(r - p, s - q));
          area += cell;
          known += cell * (p + q + r + s) / 4;
        }
      known /= area;
      ASSERT_GT(dark, 0);
      EXPECT_LT((middle / dark - known).norm(), 0.02) << camera.width << " " << aside.transpose();
    }
}

TEST(FrameRenderer, RefusesALensThatFolds) {
  Camera camera = test::smallCamera();
  camera.fx = camera.fy = 200;
  camera.distortion = {-0.5, 0, 0, 0, 0};
  EXPECT_THROW(FrameRenderer(camera, {}), std::invalid_argument);
}

TEST(FrameRenderer, BlursMotionDuringTheExposure) {
  const test::RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(1);
  const Pose pose = test::somePose(random);
  FrameLook look;
  look.noise = 0;
  const auto sharpness = [&](double way) {
    Pose end = pose;
    end.translation().x() += way;
    const GreyFrame image = rig.renderer.render({pose, end}, look, 1);
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 1; x < image.width; ++x)
        sum += std::pow(image.row(y)[x] - image.row(y)[x - 1], 2);
    return sum;
  };
  EXPECT_LT(sharpness(3e-3), 0.8 * sharpness(0));
}

} // namespace
} // namespace patina
