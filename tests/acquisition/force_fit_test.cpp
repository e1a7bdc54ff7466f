#include "acquisition/calibration/probe_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patina {
namespace {

constexpr double kZero = 0.31, kGain = 1.7;

std::vector<KnownForce> weighed(std::mt19937& random, int repeats, double noise) {
  std::normal_distribution<double> normal(0, noise);
  std::vector<KnownForce> readings;
  for (int r = 0; r < repeats; ++r)
    for (const double force : {0., 0.5, 1., 2., 5.})
      readings.push_back({force, kZero + force / kGain + normal(random)});
  return readings;
}

TEST(ForceFit, IsExactWithoutNoise) {
  std::mt19937 random(1);
  const auto fit = fitForce(weighed(random, 1, 0));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->zero, kZero, 1e-12);
  EXPECT_NEAR(fit->gain, kGain, 1e-12);
  EXPECT_TRUE(fit->rejected.empty());
}

TEST(ForceFit, StatesItsDeviations) {
  std::mt19937 random(2);
  double zero = 0, gain = 0, rejected = 0;
  constexpr int kSeeds = 2000;
  for (int i = 0; i < kSeeds; ++i) {
    const auto fit = fitForce(weighed(random, 4, 0.02));
    ASSERT_TRUE(fit);
    zero += std::pow((fit->zero - kZero) / fit->zero_deviation, 2) / kSeeds;
    gain += std::pow((fit->gain - kGain) / fit->gain_deviation, 2) / kSeeds;
    rejected += static_cast<double>(fit->rejected.size()) / kSeeds;
  }
  std::printf("squared errors over variances: zero %.2f, gain %.2f; %.3f of 20 rejected\n", zero,
              gain, rejected);
  // The mean is 1.125 for 18 degrees of freedom; rejected samples add to it.
  EXPECT_NEAR(zero, 1.15, 0.2);
  EXPECT_NEAR(gain, 1.15, 0.2);
  EXPECT_LT(rejected, 0.5);
}

TEST(ForceFit, RejectsAWrongWeight) {
  std::mt19937 random(3);
  for (std::size_t bad = 0; bad < 5; ++bad) {
    auto readings = weighed(random, 1, 0.002);
    readings[bad].reading += 0.7;
    const auto fit = fitForce(readings);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->rejected, std::vector<std::size_t>{bad});
    EXPECT_NEAR(fit->gain, kGain, 0.03);
    EXPECT_NEAR(fit->zero, kZero, 0.01);
  }
}

TEST(ForceFit, ReturnsNothingForTooFewOrUnrelatedReadings) {
  EXPECT_FALSE(fitForce({{0, 0}, {1, 1}, {2, 2}}));
  EXPECT_FALSE(fitForce({{1, 0.5}, {1, 0.6}, {2, 1}, {2, 1.1}}));
  EXPECT_FALSE(fitForce({{0, 0.3}, {1, 0.1}, {2, 0.4}, {3, 0.2}, {4, 0.3}}));
}

} // namespace
} // namespace patina
