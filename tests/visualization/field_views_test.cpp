// What slice, nodes and mouse read from a field.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "scene/surface_pick.h"
#include "support/node_values.h"
#include "visualization/layers/node_layer.h"
#include "visualization/layers/slice_layer.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;

const SurfaceField& sphere() {
  static const SurfaceField field = [] {
    FieldSpec spec;
    spec.resolution = 80;
    spec.band = 6;
    const FieldGrid grid =
        gridAround(Box3(Vec3::Constant(-kRadius), Vec3::Constant(kRadius)), spec);
    return sampleFunction([](const Vec3& p) { return p.norm() - kRadius; }, grid, spec.band);
  }();
  return field;
}

TEST(SurfacePick, HitsASphereWhereARayDoes) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const Vec3 origin = 0.2 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 aim = 0.8 * kRadius * Vec3(normal(random), normal(random), normal(random)) / 3;
    if (aim.norm() > 0.9 * kRadius) continue;
    const Vec3 direction = (aim - origin).normalized();
    const double b = origin.dot(direction);
    const double root = b * b - origin.squaredNorm() + kRadius * kRadius;
    const auto hit = firstSurfaceAlong(sphere(), origin, direction);
    ASSERT_TRUE(hit.has_value());
    const Vec3 expected = origin + direction * (-b - std::sqrt(root));
    // A hundredth of a voxel, and the trilinear value's own error, grazing rays the most.
    ASSERT_LT((*hit - expected).norm(), 0.1 * sphere().grid.voxel);
  }
}

TEST(SurfacePick, MissesWhatIsNotThere) {
  EXPECT_FALSE(firstSurfaceAlong(sphere(), Vec3(0, 0, 1), Vec3::UnitZ()));
  EXPECT_FALSE(firstSurfaceAlong(sphere(), Vec3(0.036, 0, 1), -Vec3::UnitZ()));
  EXPECT_FALSE(firstSurfaceAlong(sphere(), Vec3(1, 1, 1), Vec3::UnitX()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(firstSurfaceAlong(sphere(), Vec3(nan, 0, 0), Vec3::UnitX()));
}

TEST(NodesNear, AreTheStoredNodesWithinTheRadius) { // K26
  const Vec3 point(kRadius, 0, 0);
  const auto nodes = nodesNear(sphere(), point, 4.01);
  std::size_t expected = 0;
  const FieldGrid& grid = sphere().grid;
  for (int k = 0; k < grid.nodes[2]; ++k)
    for (int j = 0; j < grid.nodes[1]; ++j)
      for (int i = 0; i < grid.nodes[0]; ++i)
        if ((grid.toWorld(Vec3(i, j, k)) - point).norm() <= 4.01 * grid.voxel &&
            std::abs(test::phiAt(sphere(), i, j, k)) < kBeyondBand)
          ++expected;
  EXPECT_EQ(nodes.size(), expected);
  EXPECT_GT(nodes.size(), 100U);
  for (const FieldNode& node : nodes)
    ASSERT_NEAR(node.phi * grid.voxel, node.position.norm() - kRadius, 1e-8);
  EXPECT_TRUE(nodesNear(sphere(), Vec3(10, 0, 0), 4).empty());
  EXPECT_TRUE(
      nodesNear(sphere(), Vec3::Constant(std::numeric_limits<double>::infinity()), 4).empty());
}

TEST(FieldPlane, HoldsTheDistanceOnThePlaneAndNothingBeyondTheBand) {
  const FieldGrid& grid = sphere().grid;
  for (int axis = 0; axis < 3; ++axis) {
    const FieldPlane plane = planeOf(sphere(), {axis, 0.47});
    const auto across = static_cast<std::size_t>((axis + 1) % 3);
    const auto up = static_cast<std::size_t>((axis + 2) % 3);
    ASSERT_EQ(plane.columns, grid.nodes[across]);
    ASSERT_EQ(plane.rows, grid.nodes[up]);
    std::size_t known = 0, unknown = 0;
    for (int row = 0; row < plane.rows; ++row)
      for (int column = 0; column < plane.columns; ++column) {
        Vec3 q;
        q[axis] = 0.47 * (grid.nodes[static_cast<std::size_t>(axis)] - 1);
        q[static_cast<int>(across)] = column;
        q[static_cast<int>(up)] = row;
        const double phi = (grid.toWorld(q).norm() - kRadius) / grid.voxel;
        const float value = plane.phi[static_cast<std::size_t>(row * plane.columns + column)];
        if (std::isfinite(value)) {
          ++known;
          ASSERT_NEAR(value, phi, 0.02); // linear between two nodes: h^2 / 8r
        } else {
          ++unknown;
          ASSERT_GT(std::abs(phi), 4.9);
        }
      }
    EXPECT_GT(known, 100U);
    EXPECT_GT(unknown, 100U);
  }
}

TEST(FieldPlane, PositionsOutsideTheGridAreClamped) {
  EXPECT_EQ(planeOf(sphere(), {2, -3}).phi.size(), planeOf(sphere(), {2, 0}).phi.size());
  EXPECT_EQ(planeOf(sphere(), {2, 7}).phi.size(), planeOf(sphere(), {2, 1}).phi.size());
}

} // namespace
} // namespace patina
