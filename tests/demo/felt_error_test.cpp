#include "demo/felt_error.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<FeltPoint> along(double length, const std::function<double(double)>& felt,
                             const std::function<double(double)>& truth) {
  std::vector<FeltPoint> points;
  for (double x = 0; x < length; x += 0.05e-3)
    points.push_back({x, Vec3::UnitZ(), Vec3(0, 0, felt(x)), Vec3(0, 0, truth(x))});
  return points;
}

double wave(double x) {
  return 1.5 + 0.3 * std::cos(kTurn * x / 4e-3);
}

TEST(FeltError, OfTheTruthIsNone) {
  const FeltError error = feltError(along(0.032, wave, wave));
  EXPECT_EQ(error.windows, 3u);
  EXPECT_LT(error.variation, 1e-9);
  EXPECT_LT(error.whole, 1e-9);
  EXPECT_NEAR(error.true_variation, 0.3 / std::sqrt(2.), 0.01);
}

TEST(FeltError, FindsTheLagAndForgivesIt) {
  const double lag = 0.2e-3;
  const FeltError error = feltError(along(
      0.032, [&](double x) { return wave(x - lag); }, wave));
  EXPECT_NEAR(error.lag, lag, 0.011e-3);
  EXPECT_LT(error.variation, 0.03);
}

TEST(FeltError, OfNoTextureIsAllOfIt) {
  const FeltError error = feltError(along(
      0.032, [](double) { return 1.5; }, wave));
  EXPECT_NEAR(error.variation, 1, 0.01);
  EXPECT_NEAR(error.whole, 0.3 / std::sqrt(2.) / std::sqrt(1.5 * 1.5 + 0.045), 0.01);
}

TEST(FeltError, OfTheWholeKnowsAnOffsetThatTheVariationDoesNot) {
  const FeltError error = feltError(along(
      0.032, [](double x) { return wave(x) + 0.15; }, wave));
  EXPECT_LT(error.variation, 0.01);
  EXPECT_NEAR(error.whole, 0.15 / std::sqrt(1.5 * 1.5 + 0.045), 0.005);
}

TEST(FeltError, OfAnotherMaterialIsLarge) {
  const auto other = [](double x) { return 1.5 + 0.3 * std::cos(kTurn * x / 3e-3); };
  EXPECT_GT(feltError(along(0.032, other, wave)).variation, 0.9);
}

TEST(FeltError, NeedsAWindow) {
  EXPECT_THROW(feltError(along(0.008, wave, wave)), Error);
}

} // namespace
} // namespace patina
