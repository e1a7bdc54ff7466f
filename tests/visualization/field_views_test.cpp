// Values that slice, nodes and mouse read from a field.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
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

TEST(SurfacePick, HitsASphereAtTheRaysPoint) {
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
    // A hundredth of a voxel, and the trilinear value's own error, largest for grazing rays.
    ASSERT_LT((*hit - expected).norm(), 0.1 * sphere().grid.voxel);
  }
}

TEST(SurfacePick, MissesEmptySpace) {
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
            std::abs(test::phiAt(sphere(), i, j, k)) < kBackground)
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
    const auto last = grid.nodes[static_cast<std::size_t>(axis)] - 1;
    const double position = grid.origin[axis] + 0.47 * last * grid.voxel;
    const FieldPlane plane = planeOf(sphere(), {Vec3::Unit(axis), position});
    const auto across = static_cast<std::size_t>((axis + 1) % 3);
    const auto up = static_cast<std::size_t>((axis + 2) % 3);
    ASSERT_EQ(plane.columns, grid.nodes[across]);
    ASSERT_EQ(plane.rows, grid.nodes[up]);
    std::size_t known = 0, unknown = 0;
    for (int row = 0; row < plane.rows; ++row)
      for (int column = 0; column < plane.columns; ++column) {
        Vec3 q;
        q[axis] = 0.47 * last;
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
  const FieldGrid& grid = sphere().grid;
  const ValueRange range = rangeOf(grid, Vec3::UnitZ());
  EXPECT_NEAR(range.low, grid.origin.z(), 1e-12);
  EXPECT_EQ(planeOf(sphere(), {Vec3::UnitZ(), -3}).origin.z(), range.low);
  EXPECT_EQ(planeOf(sphere(), {Vec3::UnitZ(), 7}).origin.z(), range.high);
  EXPECT_NEAR(planeOf(sphere(), {}).origin.y(), boxOf(grid).center().y(), 1e-12);
}

TEST(FieldPlane, AtAnAngleHoldsTheDistanceWhereThePlaneIs) {
  const FieldGrid& grid = sphere().grid;
  const Vec3 normal = Vec3(0.3, -1, 0.8).normalized();
  const double position = 0.4 * kRadius;
  const FieldPlane plane = planeOf(sphere(), {normal, position});
  std::size_t known = 0;
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const Vec3 point = plane.origin + plane.across * column / (plane.columns - 1) +
                         plane.up * row / (plane.rows - 1);
      ASSERT_NEAR(point.dot(normal), position, 1e-12);
      const float value = plane.phi[static_cast<std::size_t>(row * plane.columns + column)];
      if (!std::isfinite(value)) continue;
      ++known;
      // Linear along three edges: 3 h^2 / 8r.
      ASSERT_NEAR(value, (point.norm() - kRadius) / grid.voxel, 0.05);
    }
  // A ring about the circle in which the plane meets the sphere.
  EXPECT_GT(known, 300U);
}

TEST(SliceText, HasADirectionAndAPosition) {
  EXPECT_EQ(parseSlice("-z").normal, Vec3(-Vec3::UnitZ()));
  EXPECT_FALSE(parseSlice("y").position);
  const SlicePosition slice = parseSlice("0, 3,4:12.5mm");
  EXPECT_NEAR((slice.normal - Vec3(0, 0.6, 0.8)).norm(), 0, 1e-12);
  EXPECT_DOUBLE_EQ(slice.position.value(), 0.0125);
  EXPECT_EQ(directionText(slice.normal), "0, 0.6, 0.8");
  EXPECT_EQ(directionText(-Vec3::UnitX()), "-x");
  EXPECT_EQ(format(parseSlice("-x:3mm")), "-x:0.003");
  for (const char* text : {"1,2,3:0.1mm", "0,1,1", "z"})
    EXPECT_EQ(parseSlice(format(parseSlice(text))), parseSlice(text)) << text;
  for (const char* bad :
       {"", "w", "0,0,0", "1,2", "1,2,3,4", "1,2,nan", "x:", "x:5furlong", "x:inf"})
    EXPECT_THROW(parseSlice(bad), Error) << bad;
}

} // namespace
} // namespace patina
