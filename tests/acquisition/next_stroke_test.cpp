#include "acquisition/registration/next_stroke.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "acquisition/registration_shapes.h"

namespace patina {
namespace {

std::vector<SurfaceMeasurement> measured(const std::vector<Vec3>& points, const Vec3& direction) {
  std::vector<SurfaceMeasurement> measurements;
  for (const Vec3& p : points) measurements.push_back({p, direction, 1e-4, 1e-4});
  return measurements;
}

// Closed form: n distances over a plane determine the shift across it and no other.
TEST(ScanKnowledge, NamesTheMotionsThatAPlaneDoesNotDetermine) {
  const SurfaceTarget plane(sheet(0.1, 0.1, 20), 0, true);
  std::vector<Vec3> points;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) points.emplace_back(0.01 * i - 0.045, 0.01 * j - 0.045, 0);
  const ScanKnowledge known = knowledgeOf(plane, measured(points, Vec3::UnitZ()), {});
  ASSERT_EQ(known.motions.size(), 6u);
  const double extent = std::sqrt(0.02);
  // Two shifts along the plane and the rotation about its normal keep their first deviations.
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(known.motions[static_cast<std::size_t>(k)].displacement, extent / 2, 0.01 * extent);
    EXPECT_LT(std::abs(known.motions[static_cast<std::size_t>(k)].translation.z()), 1e-3);
  }
  EXPECT_GT(std::abs(known.motions[2].rotation.normalized().z()), 0.99);
  EXPECT_NEAR(known.motions[2].rotation.norm(), 0.5, 0.01);
  for (std::size_t k = 3; k < 6; ++k) EXPECT_LT(known.motions[k].displacement, 2e-5);
  EXPECT_NEAR(std::sqrt(known.covariance(5, 5)), 1e-4 / 10, 1e-6); // 100 measurements
  double squares = 0;
  for (const PoseUncertainty& each : known.motions)
    squares += each.displacement * each.displacement;
  EXPECT_NEAR(known.pose, std::sqrt(squares), 1e-6);
  EXPECT_FALSE(known.complete);
}

TEST(ScanKnowledge, HeightsAreKnownWhereMeasurementsAre) {
  const SurfaceTarget plane(sheet(0.1, 0.1, 20), 0, true);
  ScanGoal goal;
  goal.radius = 0.01;
  const ScanKnowledge known =
      knowledgeOf(plane, measured({{0, 0, 0}, {0, 0, 0}}, Vec3::UnitZ()), goal);
  for (std::size_t i = 0; i < plane.mesh().positions.size(); ++i) {
    const double d = plane.mesh().positions[i].norm() / goal.radius, weight = 1 - d * d;
    if (d < 0.99) {
      const double expected = 1e-4 / (std::sqrt(2) * weight);
      EXPECT_NEAR(known.height_deviation[i], expected, 1e-5 * expected);
    } else if (d > 1.01) {
      EXPECT_TRUE(std::isinf(known.height_deviation[i]));
    }
  }
  EXPECT_GT(known.area, 0);
  EXPECT_LT(known.area, 0.05);
  // The back of the sheet is another surface.
  const ScanKnowledge back = knowledgeOf(plane, measured({{0, 0, 0}}, -Vec3::UnitZ()), goal);
  EXPECT_EQ(back.area, 0);
}

// A ridge along y on a plane: only a stroke across it determines the shift along x.
TEST(NextStroke, GoesAcrossAFeatureThatDeterminesTheFreeMotion) {
  TriangleMesh mesh = sheet(0.1, 0.1, 100);
  for (Vec3& p : mesh.positions) p.z() = 4e-3 * std::exp(-p.x() * p.x() / 2e-5);
  const SurfaceTarget ridge(mesh, 0, true);
  std::vector<Vec3> flat;
  for (int i = 0; i < 40; ++i)
    for (const double x : {-0.04, -0.03, 0.03, 0.04}) flat.emplace_back(x, 2e-3 * i - 0.04, 0);
  const auto measurements = measured(flat, Vec3::UnitZ());
  ScanGoal goal;
  goal.area = 0.01; // only the pose is wanted
  goal.height = 1;
  const ScanKnowledge before = knowledgeOf(ridge, measurements, goal);
  const std::optional<ScanStroke> stroke = nextStroke(ridge, measurements, goal, {});
  ASSERT_TRUE(stroke);
  double low = 1, high = -1;
  for (const Vec3& p : stroke->points) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
    EXPECT_LT(ridge.tree().closestPoint(p).distance, 1e-9);
  }
  EXPECT_LT(low, 3e-3);
  EXPECT_GT(high, -3e-3);
  EXPECT_LT(stroke->pose, before.pose);
}

TEST(NextStroke, IsAbsentOnceTheGoalIsMet) {
  const SurfaceTarget body(test::lumpy(12), 0, true);
  ScanGoal goal;
  goal.radius = 0.02;
  std::vector<SurfaceMeasurement> all;
  for (const Vec3& p : body.mesh().positions) {
    const SurfaceResidual residual = body.residual(p);
    all.push_back({p, residual.direction, 1e-4, 1e-4});
  }
  EXPECT_TRUE(knowledgeOf(body, all, goal).complete);
  EXPECT_FALSE(nextStroke(body, all, goal, {}));
  const std::optional<ScanStroke> first = nextStroke(body, {}, goal, {});
  ASSERT_TRUE(first);
  EXPECT_GT(first->points.size(), 20u);
  const std::optional<ScanStroke> again = nextStroke(body, {}, goal, {});
  EXPECT_EQ(first->points, again->points) << "it is deterministic";
}

TEST(NextStroke, KeepsToTheReachableFaces) {
  const SurfaceTarget body(test::lumpy(20), 0, true);
  ScanGoal goal;
  goal.radius = 0.01;
  for (std::size_t face = 0; face < body.mesh().triangles.size(); ++face)
    goal.reachable.push_back(faceNormal(body.mesh(), face).z() > 0.5);
  const std::optional<ScanStroke> stroke = nextStroke(body, {}, goal, {});
  ASSERT_TRUE(stroke);
  EXPECT_GT(stroke->points[stroke->points.size() / 2].z(), 0);
  goal.reachable.pop_back();
  EXPECT_THROW((void)nextStroke(body, {}, goal, {}), std::invalid_argument);
  goal.reachable.assign(body.mesh().triangles.size(), false);
  EXPECT_FALSE(nextStroke(body, {}, goal, {}));
  StrokeOptions options;
  options.spacing = 0;
  EXPECT_THROW((void)nextStroke(body, {}, {}, options), std::invalid_argument);
}

} // namespace
} // namespace patina
