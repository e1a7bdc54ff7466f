// The brush's weight, its size and the positions of its dabs (K17, K19).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "authoring/brush/dab.h"
#include "authoring/brush/painter.h"
#include "authoring/paint_fixture.h"

namespace patina {
namespace {

Brush shaped(BrushShape shape, double falloff) {
  Brush brush;
  brush.shape = shape;
  brush.falloff = falloff;
  return brush;
}

// T-K17: the mean of w over the disc.
double meanOverDisc(const Brush& brush) {
  constexpr int kRings = 200000;
  double sum = 0;
  for (int k = 0; k < kRings; ++k) {
    const double x = (k + 0.5) / kRings;
    sum += 2 * x * brushWeight(brush, 0.003 * x, 0.003) / kRings;
  }
  return sum;
}

TEST(Brush, WeightIntegratesToItsClosedForm) {
  for (const double f : {0.5, 1.0, 2.0, 5.0}) {
    EXPECT_NEAR(meanOverDisc(shaped(BrushShape::power, f)), f / (f + 2), 1e-6);
    EXPECT_NEAR(meanOverDisc(shaped(BrushShape::cone, f)), 2 / ((f + 1) * (f + 2)), 1e-6);
    EXPECT_NEAR(meanOverDisc(shaped(BrushShape::smooth, f)), 1 / (f + 1), 1e-6);
  }
}

TEST(Brush, WeightFallsFromOneToZeroAtTheRadius) {
  for (const BrushShape shape : {BrushShape::power, BrushShape::cone, BrushShape::smooth}) {
    const Brush brush = shaped(shape, 3);
    EXPECT_EQ(brushWeight(brush, 0, 0.01), 1);
    EXPECT_EQ(brushWeight(brush, 0.01, 0.01), 0);
    EXPECT_EQ(brushWeight(brush, 0.02, 0.01), 0);
    EXPECT_EQ(brushWeight(brush, 0, 0), 0);
    EXPECT_EQ(brushWeight(brush, std::nan(""), 0.01), 0);
    for (int k = 0; k < 100; ++k)
      EXPECT_GE(brushWeight(brush, 1e-4 * k, 0.01), brushWeight(brush, 1e-4 * (k + 1), 0.01));
  }
}

// T-K19.
TEST(Brush, RadiusFollowsTheForceWithinItsLimits) {
  Brush brush;
  brush.radius = 0.002;
  brush.radius_per_force = 0.001;
  brush.min_radius = 0.0025;
  brush.max_radius = 0.006;
  EXPECT_DOUBLE_EQ(brushRadius(brush, 1), 0.003);
  EXPECT_DOUBLE_EQ(brushRadius(brush, 3), 0.005);
  EXPECT_EQ(brushRadius(brush, 0), 0.0025);
  EXPECT_EQ(brushRadius(brush, 1e9), 0.006);
}

FieldGrid someGrid() {
  return gridAround(Box3(Vec3::Constant(-0.05), Vec3::Constant(0.05)), FieldSpec{});
}

TEST(StrokePath, RadiusIsSmoothUnderNoisyForceAtAnyRate) {
  Brush brush;
  brush.radius = 0;
  brush.radius_per_force = 0.001;
  StrokePath noisy(brush, someGrid());
  double least = 1, most = 0;
  for (int k = 0; k < 600; ++k) {
    const auto steps = noisy.advanceTo({k / 600.0, Vec3::Zero(), k % 2 ? 6.0 : 4.0});
    if (k < 300) continue;
    least = std::min(least, steps.back().radius);
    most = std::max(most, steps.back().radius);
  }
  EXPECT_LT(most - least, 0.0001); // for a radius of 2 mm
  EXPECT_NEAR(most, 0.005, 0.0001);
  double ends[2];
  for (int rate = 0; rate < 2; ++rate) {
    StrokePath path(brush, someGrid());
    const int n = rate ? 12 : 6;
    (void)path.advanceTo({0, Vec3::Zero(), 1});
    for (int k = 1; k <= n; ++k)
      ends[rate] = path.advanceTo({0.2 * k / n, Vec3::Zero(), 5}).back().radius;
  }
  EXPECT_NEAR(ends[0], ends[1], 1e-12);
}

TEST(StrokePath, StepsAreAQuarterOfTheRadiusApartAtMost) {
  Brush brush;
  brush.radius = 0.004;
  StrokePath path(brush, someGrid());
  (void)path.advanceTo({0, Vec3(-0.03, 0, 0), 0});
  const auto steps = path.advanceTo({1, Vec3(0.03, 0.01, 0), 0});
  Vec3 last(-0.03, 0, 0);
  for (const PathStep& step : steps) {
    EXPECT_LE((step.position - last).norm(), 0.001 * (1 + 1e-9));
    EXPECT_TRUE(step.connected);
    last = step.position;
  }
  EXPECT_EQ(last, Vec3(0.03, 0.01, 0));
}

TEST(StrokePath, NeedlesAndFarJumpsTerminate) {
  Brush brush;
  brush.radius = 1e-12;
  StrokePath path(brush, someGrid());
  (void)path.advanceTo({0, Vec3(-1e12, 0, 0), 0});
  EXPECT_LE(path.advanceTo({1, Vec3(1e12, 0, 0), 0}).size(), 20000u);
  EXPECT_FALSE(path.reached());
  EXPECT_LE(path.advanceTo({2, Vec3(0, 0, 0), 0}).size(), 20000u);
  EXPECT_TRUE(path.reached());
  EXPECT_TRUE(path.advanceTo({3, Vec3(0, 1e300, 0), 0}).size() <= 20000u);
  EXPECT_TRUE(path.advanceTo({4, Vec3::Constant(std::nan("")), 0}).empty());
  EXPECT_TRUE(path.advanceTo({5, Vec3(0, 0, 0), INFINITY}).empty());
}

TEST(Dab, WeighsByTheDistanceToItsPath) {
  Brush brush;
  const Dab dab{Vec3(0, 0, 0), Vec3(0.01, 0, 0), 0.01, 0.02};
  EXPECT_DOUBLE_EQ(weightAt(dab, brush, Vec3(-0.005, 0, 0)), 0.5);
  EXPECT_DOUBLE_EQ(weightAt(dab, brush, Vec3(0.005, 0.006, 0)), 1 - 0.006 / 0.015);
  EXPECT_DOUBLE_EQ(weightAt(dab, brush, Vec3(0.02, 0, 0)), 0.5);
  EXPECT_DOUBLE_EQ(dab.boundingRadius(), 0.025);
}

} // namespace
} // namespace patina
