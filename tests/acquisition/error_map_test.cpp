// Tests the map of a registered path's errors against sums over all samples.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "acquisition/registration/error_map.h"
#include "acquisition/registration_shapes.h"

namespace patina {
namespace {

Registration scattered(const TriangleMesh& mesh, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Registration made;
  for (int i = 0; i < count; ++i) {
    SurfaceResidual miss;
    miss.foot.face = static_cast<std::int32_t>(unit(random) * mesh.triangles.size());
    const double a = unit(random), b = (1 - a) * unit(random);
    miss.foot.barycentric = Vec3(a, b, 1 - a - b);
    miss.at = position(mesh, miss.foot);
    miss.distance = 2e-3 * (unit(random) - 0.5);
    made.residuals.push_back(miss);
    made.inliers.push_back(unit(random) < 0.8);
  }
  return made;
}

TEST(ErrorMap, IsTheWeightedMeanOfAllSamplesInReach) {
  const TriangleMesh mesh = test::lumpy(12);
  const Registration found = scattered(mesh, 400, 3);
  const double reach = 0.006;
  const std::vector<float> map = errorMapOf(mesh, found, reach);
  ASSERT_EQ(map.size(), mesh.positions.size());
  int with = 0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < found.residuals.size(); ++i) { // a convex body: one side is near
      const double d = (found.residuals[i].at - mesh.positions[v]).norm() / reach;
      const double weight = found.inliers[i] && d < 1 ? std::pow(1 - d * d, 2) : 0;
      sum += weight * std::abs(found.residuals[i].distance);
      weights += weight;
    }
    if (weights == 0) {
      EXPECT_TRUE(std::isnan(map[v]));
      continue;
    }
    ++with;
    EXPECT_NEAR(map[v], sum / weights, 1e-9);
  }
  EXPECT_GT(with, 200);
  EXPECT_LT(with, static_cast<int>(map.size()));
}

TEST(ErrorMap, IgnoresSamplesOnTheOtherSideOfAThinWall) {
  TriangleMesh mesh = sheet(0.1, 0.1, 20);
  const auto upper = mesh.positions.size(), faces = mesh.triangles.size();
  for (std::size_t v = 0; v < upper; ++v)
    mesh.positions.push_back(mesh.positions[v] - 1e-3 * Vec3::UnitZ());
  const auto first = static_cast<std::int32_t>(upper);
  for (std::size_t f = 0; f < faces; ++f) {
    const Triangle t = mesh.triangles[f];
    mesh.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  }
  Registration found;
  SurfaceResidual miss;
  miss.foot = {static_cast<std::int32_t>(faces / 2), Vec3(0.3, 0.3, 0.4)};
  miss.at = position(mesh, miss.foot);
  miss.distance = -5e-4;
  found.residuals = {miss};
  found.inliers = {true};
  const std::vector<float> map = errorMapOf(mesh, found, 0.02);
  int above = 0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    if (v >= upper)
      EXPECT_TRUE(std::isnan(map[v]));
    else if (!std::isnan(map[v])) {
      ++above;
      EXPECT_FLOAT_EQ(map[v], 5e-4F);
    }
  }
  EXPECT_GT(above, 10);
  EXPECT_THROW(errorMapOf(mesh, found, 0), std::invalid_argument);
}

} // namespace
} // namespace patina
