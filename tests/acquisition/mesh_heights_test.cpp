#include "acquisition/texture/mesh_heights.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kRadius = 0.03;

double ripple(double way) {
  return 5e-5 * std::cos(kTwoPi * way / 4e-3);
}

struct Crossing {
  std::vector<PathSample> path;
  ScanHeights heights; // along z
};

// The tip crosses the top of a ball at constant speed and rests there for a while.
Crossing overTheBall(const Pose& mesh_from_scan) {
  Crossing crossing;
  crossing.heights.plane = {mesh_from_scan.linear().transpose() * Vec3::UnitZ(),
                            mesh_from_scan.inverse() * Vec3(0, 0, kRadius)};
  const Vec3& up = crossing.heights.plane.normal;
  double flat = 0, last = 0, way = -0.6 * kRadius;
  for (int i = 0; i < 1200; ++i) {
    const bool stands = i >= 500 && i < 700;
    if (!stands) way += 0.036 / 1000;
    const double angle = way / kRadius, tremor = 3e-5 * std::sin(kTwoPi * 9 * i * 2e-3);
    const Vec3 surface = (kRadius + ripple(way)) * Vec3(std::sin(angle), 0, std::cos(angle));
    PathSample sample;
    sample.t = 2e-3 * i;
    sample.touching = true;
    sample.position = mesh_from_scan.inverse() * (surface + Vec3(0, tremor, 0)).eval();
    if (i > 0) flat += std::abs(surface.x() - last);
    last = surface.x();
    crossing.heights.heights.push_back(
        {sample.t, {flat, up.dot(sample.position - crossing.heights.plane.point), 1e-5}, 0});
    sample.position += 0.2e-3 * up; // the height of the path does not count
    crossing.path.push_back(sample);
  }
  return crossing;
}

Pose somePose() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  pose.translation() = Vec3(0.1, -0.2, 0.3);
  return pose;
}

TEST(MeshHeights, AreTheResidualsOfTheShape) {
  const SurfaceTarget ball(icosphere(kRadius, 40), 0, true);
  const Crossing crossing = overTheBall(somePose());
  const std::vector<ScanHeight> over =
      heightsOverMesh(ball, somePose(), crossing.path, crossing.heights);
  ASSERT_EQ(over.size(), crossing.path.size());
  const double begin = -0.6 * kRadius + 0.036 / 1000;
  for (std::size_t i = 0; i < over.size(); ++i) {
    const double moved = static_cast<double>(i < 500 ? i : std::max<std::size_t>(i, 699) - 200);
    const double way = i < 500 || i >= 700 ? moved * 0.036 / 1000 : 499 * 0.036 / 1000;
    // Facets deviate from the ball by 3 um, the arc length by half a sample at each end of the
    // rest.
    EXPECT_NEAR(over[i].point.height, ripple(begin + way), 6e-6) << i;
    EXPECT_NEAR(over[i].point.arc_length, way, 0.15e-3) << i;
    EXPECT_LE(over[i].point.sigma, 1e-5);
  }
}

TEST(MeshHeights, ArcLengthDoesNotGrowAtRest) {
  const SurfaceTarget ball(icosphere(kRadius, 40), 0, true);
  const Crossing crossing = overTheBall(somePose());
  const std::vector<ScanHeight> over =
      heightsOverMesh(ball, somePose(), crossing.path, crossing.heights);
  EXPECT_LT(over[640].point.arc_length - over[560].point.arc_length, 1e-6); // 160 ms of tremor
}

TEST(MeshHeights, AreAbsentOnASteepSide) {
  const SurfaceTarget ball(icosphere(kRadius, 40), 0, true);
  Crossing crossing = overTheBall(Pose::Identity());
  crossing.heights.plane.normal = Vec3::UnitX();
  EXPECT_LT(heightsOverMesh(ball, Pose::Identity(), crossing.path, crossing.heights).size(), 300u);
}

TEST(MeshHeights, HaveTheMeanNormalUnderThePath) {
  const SurfaceTarget ball(icosphere(kRadius, 40), 0, true);
  const Crossing crossing = overTheBall(somePose());
  const Vec3 normal = somePose().linear() * meanNormal(ball, somePose(), crossing.path);
  EXPECT_GT(normal.z(), 0.99);
  std::vector<PathSample> around;
  for (int i = 0; i < 360; ++i) {
    PathSample sample;
    const double angle = kTwoPi * i / 360;
    sample.position = kRadius * Vec3(std::cos(angle), 0, std::sin(angle));
    around.push_back(sample);
  }
  EXPECT_THROW(meanNormal(ball, Pose::Identity(), around), Error);
}

} // namespace
} // namespace patina
