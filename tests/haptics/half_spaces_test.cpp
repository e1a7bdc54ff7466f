#include "haptics/contact/half_spaces.h"

#include <bit>
#include <limits>
#include <numeric>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"

namespace patina {
namespace {

double worstOf(const Walls& walls, const Vec3& y) {
  double worst = 0;
  for (int i = 0; i < walls.count; ++i) worst = std::max(worst, -walls[i].height(y));
  return worst;
}

// The point of the planes of these walls that is nearest to x, where every wall pushes.
std::optional<Vec3> heldPoint(const Walls& walls, unsigned which, const Vec3& x) {
  std::vector<int> active;
  for (int i = 0; i < walls.count; ++i)
    if (which >> i & 1U) active.push_back(i);
  const auto n = static_cast<Eigen::Index>(active.size());
  Eigen::MatrixXd normals(3, n);
  Eigen::VectorXd violated(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    normals.col(k) = walls[active[static_cast<std::size_t>(k)]].normal;
    violated[k] = -walls[active[static_cast<std::size_t>(k)]].height(x);
  }
  const Eigen::MatrixXd gram = normals.transpose() * normals;
  if (n > 0 && std::abs(gram.determinant()) < 1e-7) return std::nullopt;
  const Eigen::VectorXd load = n > 0 ? gram.inverse() * violated : violated;
  if (n > 0 && load.minCoeff() < 0) return std::nullopt;
  return x + normals * load;
}

// Tries every set of at most three walls; of the points that violate least, returns the nearest.
Vec3 bruteForce(const Walls& walls, const Vec3& x) {
  Vec3 best = x;
  double least = std::numeric_limits<double>::infinity(), nearest = least;
  for (unsigned which = 0; which < 1U << walls.count; ++which) {
    if (std::popcount(which) > 3) continue;
    const std::optional<Vec3> z = heldPoint(walls, which, x);
    if (!z) continue;
    const double worst = std::max(worstOf(walls, *z), 1e-9), far = (*z - x).norm();
    if (worst > least * (1 + 1e-6) || (worst > least * (1 - 1e-6) && far >= nearest)) continue;
    least = worst;
    nearest = far;
    best = *z;
  }
  return best;
}

void expectSum(const Walls& walls, const Vec3& x, const WallProjection& held) {
  Vec3 sum = x;
  for (int k = 0; k < held.count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    ASSERT_GE(held.multiplier[i], 0);
    sum += held.multiplier[i] * walls[held.active[i]].normal;
  }
  ASSERT_LT((sum - held.z).norm(), 1e-12);
}

// Walls through a common free point, seen from points on either side of them; some walls twice.
TEST(ProjectOntoWalls, FindsTheNearestFreePoint) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::array<int, 4> met{};
  for (int round = 0; round < 20000; ++round) {
    const Vec3 free = unit(random) * randomDirection(random);
    Walls walls;
    const int count = round % (Walls::kMax + 1);
    for (int i = 0; i < count; ++i) {
      Vec3 normal = randomDirection(random);
      if (i > 0 && unit(random) < 0.2) normal = walls[i - 1].normal;
      walls.add({normal, normal.dot(free) - unit(random) * (round % 3), Vec3::Zero()});
    }
    const Vec3 x = 3 * unit(random) * randomDirection(random);
    const WallProjection held = projectOntoWalls(walls, x);
    ASSERT_LE(worstOf(walls, held.z), 1e-8) << round;
    ASSERT_LT((held.z - bruteForce(walls, x)).norm(), 1e-6) << round;
    expectSum(walls, x, held);
    ++met[static_cast<std::size_t>(held.count)];
  }
  for (const int times : met) EXPECT_GT(times, 200);
}

// The same holds for nearly parallel walls.
TEST(ProjectOntoWalls, IsExactNextToParallelWalls) {
  std::mt19937 random(4);
  for (int round = 0; round < 2000; ++round) {
    const Vec3 n = randomDirection(random);
    const double apart = std::pow(10.0, -1 - round % 3);
    Walls walls;
    for (int i = 0; i < 2 + round % 2; ++i)
      walls.add({(n + apart * randomDirection(random)).normalized(), 0, Vec3::Zero()});
    const Vec3 x = -n + 0.5 * randomDirection(random);
    const WallProjection held = projectOntoWalls(walls, x);
    ASSERT_LE(worstOf(walls, held.z), 1e-8) << round;
    ASSERT_LT((held.z - bruteForce(walls, x)).norm(), 1e-5) << round;
    expectSum(walls, x, held);
  }
}

TEST(ProjectOntoWalls, ViolatesLeastIfNoPointIsFree) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 2000; ++round) {
    const Vec3 n = randomDirection(random), x = unit(random) * randomDirection(random);
    Walls walls;
    walls.add({n, 0.5 + unit(random), Vec3::Zero()});
    walls.add({-n, 0.5 + unit(random), Vec3::Zero()});
    if (round % 2) walls.add({n.unitOrthogonal(), unit(random), Vec3::Zero()});
    const WallProjection held = projectOntoWalls(walls, x);
    ASSERT_NEAR(worstOf(walls, held.z), worstOf(walls, bruteForce(walls, x)), 1e-9) << round;
    expectSum(walls, x, held);
  }
}

TEST(ProjectOntoWalls, DoesNotHoldAPointOnAWall) {
  Walls walls;
  walls.add({Vec3::UnitZ(), 1, Vec3::Zero()});
  EXPECT_EQ(projectOntoWalls(walls, Vec3(5, 6, 1)).count, 0);
  EXPECT_EQ(projectOntoWalls(walls, Vec3(5, 6, 1 - 1e-10)).count, 0);
  EXPECT_EQ(projectOntoWalls(walls, Vec3(5, 6, 1 - 1e-8)).count, 1);
}

// The reference is a list that follows the header's rules.
TEST(Walls, AppendTheNewestAndDropTheFarthest) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  Walls walls;
  std::vector<WallPlane> expected;
  for (int round = 0; round < 3000; ++round) {
    if (!expected.empty() && unit(random) < 0.3) {
      const auto i = static_cast<std::ptrdiff_t>(random() % expected.size());
      walls.remove(static_cast<int>(i));
      expected.erase(expected.begin() + i);
    } else {
      const WallPlane wall{randomDirection(random), unit(random), 9 * randomDirection(random)};
      if (expected.size() == Walls::kMax)
        expected.erase(std::max_element(expected.begin(), expected.end(), [&](auto& a, auto& b) {
          return (a.point - wall.point).norm() < (b.point - wall.point).norm();
        }));
      walls.add(wall);
      expected.push_back(wall);
    }
    ASSERT_EQ(walls.count, static_cast<int>(expected.size()));
    for (int i = 0; i < walls.count; ++i) {
      const WallPlane& wall = expected[static_cast<std::size_t>(i)];
      ASSERT_EQ(walls[i].normal, wall.normal);
      ASSERT_EQ(walls[i].offset, wall.offset);
      ASSERT_EQ(walls[i].point, wall.point);
    }
  }
}

} // namespace
} // namespace patina
