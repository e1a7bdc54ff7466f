#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/studies/field/study_shapes.h"
#include "support/study_rows.h"

namespace patina {
namespace {

using test::more;
using test::quickTables;

TEST(SurfacesStudy, EveryRowIsMeasured) {
  ASSERT_EQ(quickTables<surfacesStudy>().size(), 6u);
  for (const WorkPrecisionTable& table : quickTables<surfacesStudy>()) {
    EXPECT_GE(table.rows.size(), 2u) << table.title;
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_GT(row.ns, 0) << table.title;
      EXPECT_GT(row.bytes, 0) << table.title;
      EXPECT_TRUE(std::isfinite(row.error) && row.error <= row.error_max) << table.title;
    }
  }
}

TEST(SurfacesStudy, ForceAndLoopEnergyAreOfOrderTwo) {
  int judged = 0;
  for (const WorkPrecisionTable& table : quickTables<surfacesStudy>()) {
    if (!table.order_expected) continue;
    ++judged;
    // Work falls faster than its asymptote unless the voxel is small against the loop.
    const bool energy = table.error_unit == "J";
    EXPECT_GT(*table.order_fitted, *table.order_expected - 0.2) << table.title;
    EXPECT_LT(*table.order_fitted, *table.order_expected + (energy ? 1.2 : 0.2)) << table.title;
  }
  EXPECT_EQ(judged, 4);
}

// The stored energy is 3.1 mJ. The rows are those of the coarse field (kim, high) and of the fine
// one.
TEST(SurfacesStudy, ProxyGeneratesNoEnergyAroundALoop) {
  const WorkPrecisionTable& energy = quickTables<surfacesStudy>()[3];
  ASSERT_EQ(energy.rows.size(), 8u);
  const WorkPrecisionRow &coarse = energy.rows[1], &fine = energy.rows[5];
  for (const std::size_t row : {0, 1, 4, 5}) {
    ASSERT_EQ(energy.rows[row].settings[0].second.asString(), "proxy");
    EXPECT_LT(more(energy.rows[row], "given at most [J]"), 1e-3 * 3.1e-3) << row; // 5e-4 measured
  }
  ASSERT_EQ(fine.settings[2].second.asString(), "high");
  // The energy from the field falls with the voxel; the .3 uJ of an incomplete tick do not.
  EXPECT_LT(fine.error, std::max(coarse.error / 3.5, 5e-7));
  EXPECT_LT(coarse.error, 5e-6);
}

TEST(SurfacesStudy, RedistancingCorrectsTheDepthOfAnOverlap) {
  const WorkPrecisionTable& overlap = quickTables<surfacesStudy>()[4];
  ASSERT_EQ(overlap.rows.size(), 2u);
  const double voxel = 0.06 / (80 - 16);
  EXPECT_GT(overlap.rows[0].error_max, 5e-3); // union by min alone
  // Deeper than the band the exit direction comes from nodes 8 voxels apart: usually right to a
  // voxel, but not at every point near the axis.
  EXPECT_LT(overlap.rows[1].error, voxel);
  EXPECT_LT(overlap.rows[1].error_max, 0.3 * overlap.rows[0].error_max);
  for (const WorkPrecisionRow& row : overlap.rows)
    EXPECT_LT(more(row, "1 mm below free skin, max [m]"), 0.1 * voxel);
}

// The reference is a brute-force search over both spheres' free parts.
TEST(LensDepth, AgreesWithBruteForce) {
  const double R = 0.02, a = 0.01;
  std::vector<Vec3> surface;
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 800; ++j) {
      const double theta = std::acos(1 - 2 * (i + 0.5) / 400), phi = 2 * M_PI * j / 800;
      const Vec3 n(std::cos(theta), std::sin(theta) * std::cos(phi),
                   std::sin(theta) * std::sin(phi));
      for (const double c : {-a, a}) {
        const Vec3 q = Vec3(c, 0, 0) + R * n;
        if ((q + Vec3(c, 0, 0)).norm() >= R) surface.push_back(q);
      }
    }
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-0.006, 0.006);
  for (int i = 0; i < 20; ++i) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    double nearest = 1;
    for (const Vec3& q : surface) nearest = std::min(nearest, (q - p).norm());
    EXPECT_NEAR(lensDepth(p, R, a), nearest, 1e-4);
  }
}

} // namespace
} // namespace patina
