#include "demo/truth_errors.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<ForcePoint> along(double length, const std::function<double(double)>& felt,
                              const std::function<double(double)>& truth) {
  std::vector<ForcePoint> points;
  for (double x = 0; x < length; x += 0.05e-3)
    points.push_back({x, Vec3::UnitZ(), Vec3(0, 0, felt(x)), Vec3(0, 0, truth(x))});
  return points;
}

double wave(double x) {
  return 1.5 + 0.3 * std::cos(kTurn * x / 4e-3);
}

TEST(ForceError, IsZeroForTheTruth) {
  const ForceError error = forceError(along(0.032, wave, wave));
  EXPECT_EQ(error.windows, 3u);
  EXPECT_LT(error.texture_error, 1e-9);
  EXPECT_LT(error.relative_error, 1e-9);
  EXPECT_NEAR(error.true_variation, 0.3 / std::sqrt(2.), 0.01);
}

TEST(ForceError, FindsAndRemovesTheLag) {
  const double lag = 0.2e-3;
  const ForceError error = forceError(along(
      0.032, [&](double x) { return wave(x - lag); }, wave));
  EXPECT_NEAR(error.spatial_lag, lag, 0.011e-3);
  EXPECT_LT(error.texture_error, 0.03);
}

TEST(ForceError, IsOneWithoutTexture) {
  const ForceError error = forceError(along(
      0.032, [](double) { return 1.5; }, wave));
  EXPECT_NEAR(error.texture_error, 1, 0.01);
  EXPECT_NEAR(error.relative_error, 0.3 / std::sqrt(2.) / std::sqrt(1.5 * 1.5 + 0.045), 0.01);
}

TEST(ForceError, TotalErrorIncludesAnOffsetThatTheVariationIgnores) {
  const ForceError error = forceError(along(
      0.032, [](double x) { return wave(x) + 0.15; }, wave));
  EXPECT_LT(error.texture_error, 0.01);
  EXPECT_NEAR(error.relative_error, 0.15 / std::sqrt(1.5 * 1.5 + 0.045), 0.005);
}

TEST(ForceError, IsLargeForAnotherMaterial) {
  const auto other = [](double x) { return 1.5 + 0.3 * std::cos(kTurn * x / 3e-3); };
  EXPECT_GT(forceError(along(0.032, other, wave)).texture_error, 0.9);
}

TEST(ForceError, NeedsAWindow) {
  EXPECT_THROW(forceError(along(0.008, wave, wave)), Error);
}

} // namespace
} // namespace patina
