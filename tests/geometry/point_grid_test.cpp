// Tests the grid against all pairs and against all points.
#include "geometry/mesh/point_grid.h"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace patina {
namespace {

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

std::vector<Vec3> cloud(std::size_t count, const Vec3& size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(size.x() * unit(random) - 3, size.y() * unit(random) + 1e3,
                        size.z() * unit(random));
  return points;
}

Pairs pairsOf(const std::vector<Vec3>& points, double side, double reach) {
  const PointGrid grid(points, side);
  Pairs pairs;
  for (std::size_t n = 0; n < grid.size(); ++n)
    grid.forEachNear(n, reach, [&](std::size_t m) {
      pairs.insert(
          {static_cast<std::uint32_t>(grid.point(n)), static_cast<std::uint32_t>(grid.point(m))});
      return false;
    });
  return pairs;
}

Pairs pairsByDistance(const std::vector<Vec3>& points, double reach) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (std::uint32_t j = 0; j < points.size(); ++j)
      if (i != j && (points[i] - points[j]).norm() <= reach) pairs.insert({i, j});
  return pairs;
}

TEST(PointGrid, FindsEachNearPointOnce) {
  for (const Vec3& size : {Vec3(1, 1, 1), Vec3(20, 0, 0), Vec3(0, 5, 5), Vec3(0.01, 0.01, 30)}) {
    const std::vector<Vec3> points = cloud(400, size, 7);
    for (const double reach : {0.02, 0.11})
      EXPECT_EQ(pairsOf(points, 1.3 * reach, reach), pairsByDistance(points, reach))
          << size.transpose() << ", " << reach;
  }
}

TEST(PointGrid, StopsOnRequest) {
  const std::vector<Vec3> points = cloud(400, {1, 1, 1}, 8);
  const PointGrid grid(points, 0.3);
  for (std::size_t n = 0; n < grid.size(); ++n) {
    int visits = 0;
    grid.forEachNear(n, 0.3, [&](std::size_t) { return ++visits == 2; });
    EXPECT_LE(visits, 2);
  }
}

TEST(PointGrid, FindsEveryPointOfABoxAndFewOthers) {
  const std::vector<Vec3> points = cloud(2000, {1, 2, 0.5}, 3);
  const double side = 0.09;
  const PointGrid grid(points, side);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 300; ++k) {
    Box3 box(points[static_cast<std::size_t>(k)]);
    box.extend(Vec3(box.min() + 0.2 * Vec3(unit(random), -unit(random), unit(random))));
    std::set<std::uint32_t> found;
    grid.forEachIn(box, [&](std::size_t n) {
      const auto i = static_cast<std::uint32_t>(grid.point(n));
      EXPECT_TRUE(found.insert(i).second) << "once";
      EXPECT_LE(box.exteriorDistance(points[i]), std::sqrt(3.) * side);
    });
    for (std::uint32_t i = 0; i < points.size(); ++i)
      EXPECT_TRUE(found.contains(i) || !box.contains(points[i]));
  }
  grid.forEachIn(Box3(Vec3(5, 5, 5), Vec3(6, 6, 6)), [](std::size_t) { FAIL() << "no point"; });
}

TEST(PointGrid, AcceptsOnePointManyCoincidentPointsAndNone) {
  EXPECT_TRUE(pairsOf({}, 1, 1).empty());
  EXPECT_TRUE(pairsOf({Vec3(1, 2, 3)}, 0, 0).empty());
  const std::vector<Vec3> same(10000, Vec3(1, 2, 3));
  const std::size_t count = pairsOf(same, 0, 0).size();
  EXPECT_GT(count, same.size());
  EXPECT_LE(count, 64 * same.size());
}

// Nearly all points then lie in one part of the grid's index.
TEST(PointGrid, FindsAllWhereOnePointIsThousandsOfTimesFarther) {
  for (const double far : {1e3, 4e4}) {
    std::vector<Vec3> points = cloud(3000, {1, 1, 1}, 9);
    points.emplace_back(0, 0, far);
    EXPECT_EQ(pairsOf(points, 0.05, 0.05), pairsByDistance(points, 0.05)) << far;
  }
}

TEST(PointGrid, MissesNothingWhereOnePointIsAMillionTimesFarther) {
  std::vector<Vec3> points = cloud(60, {1, 1, 1}, 9); // all in one cell: fewer than it looks at
  points.resize(30);
  points.emplace_back(1e9, 0, 0);
  EXPECT_EQ(pairsOf(points, 0.05, 0.05), pairsByDistance(points, 0.05));
}

} // namespace
} // namespace patina
