#include "acquisition/profile/compliance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace patina {
namespace {

constexpr double kForceStep = 0.02, kForceNoise = 0.005;
const double kForceSigma = std::hypot(kForceNoise, kForceStep / std::sqrt(12.));

// Presses of 0.5 s to 3.4 N, 0.1 s apart, at 500 Hz, with noise that correlates between samples.
std::vector<PressSample> presses(double stiffness, double noise, std::uint32_t seed,
                                 double alike = 0, bool exact = false) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PressSample> samples;
  double error = normal(random);
  for (int i = 0; i < 900; ++i) {
    const double t = i / 500., in = std::fmod(t, 0.6);
    const double force = in < 0.5 ? 3.4 * std::sin(std::numbers::pi * in / 0.5) : 0;
    error = alike * error + std::sqrt(1 - alike * alike) * normal(random);
    const double shown =
        exact ? force
              : kForceStep * std::round((force + kForceNoise * normal(random)) / kForceStep);
    samples.push_back({t, force / stiffness + noise * error, shown});
  }
  return samples;
}

double plainRegression(const std::vector<PressSample>& samples) {
  double n = 0, x = 0, f = 0, xx = 0, xf = 0;
  for (const PressSample& s : samples) {
    if (s.force < 0.05) continue;
    n += 1, x += s.displacement, f += s.force;
    xx += s.displacement * s.displacement, xf += s.displacement * s.force;
  }
  return (xf - x * f / n) / (xx - x * x / n);
}

// A08: a spring without noise.
TEST(Compliance, IsExactForALinearSpring) {
  const auto estimate = estimateCompliance(presses(800, 0, 1, 0, true), 0);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->compliance, 1 / 800., 1e-12);
  EXPECT_NEAR(estimate->stiffness, 800, 1e-6);
  EXPECT_EQ(estimate->loadings, 3u);
  EXPECT_LT(estimate->displacement_noise, 1e-9);
}

struct Seeds {
  double mean = 0, deviation = 0, stated = 0, plain = 0;
};

Seeds over(int seeds, double stiffness, double noise, double alike) {
  Seeds result;
  double squares = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const std::vector<PressSample> samples =
        presses(stiffness, noise, static_cast<std::uint32_t>(seed), alike);
    const auto estimate = estimateCompliance(samples, kForceSigma);
    if (!estimate) continue;
    result.mean += estimate->stiffness / seeds;
    squares += estimate->stiffness * estimate->stiffness / seeds;
    result.stated += estimate->stiffness_deviation / seeds;
    result.plain += plainRegression(samples) / seeds;
  }
  result.deviation = std::sqrt(squares - result.mean * result.mean);
  return result;
}

TEST(Compliance, IsUnbiasedByNoiseAndItsDeviationHolds) {
  for (const double stiffness : {300., 1000., 3000.}) {
    const Seeds found = over(1000, stiffness, 0.3e-3, 0);
    std::printf(
        "%6.0f N/m: bias %+.3f %%, stated / true deviation %.3f, plain regression %+.1f %%\n",
        stiffness, 100 * (found.mean / stiffness - 1), found.stated / found.deviation,
        100 * (found.plain / stiffness - 1));
    EXPECT_NEAR(found.mean / stiffness, 1, 0.005);
    EXPECT_NEAR(found.stated / found.deviation, 1, 0.1);
  }
  EXPECT_LT(over(100, 3000, 0.3e-3, 0).plain, 0.65 * 3000) << "presses too hard to tell";
}

// Errors of a smoothed path are correlated from sample to sample.
TEST(Compliance, DeviationHoldsUnderCorrelatedErrors) {
  const Seeds found = over(1000, 1000, 0.3e-3, 0.8);
  EXPECT_NEAR(found.mean / 1000, 1, 0.005);
  EXPECT_NEAR(found.stated / found.deviation, 1, 0.1);
}

constexpr double kScatteredStiffness = 800, kScatter = 0.08; // the slopes' deviation is relative

// Each press has an error of its own that grows with the force, like that of a tilted path.
std::vector<PressSample> scatteredPresses(int count, std::uint32_t seed, double sigma = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PressSample> samples;
  for (int press = 0; press < count; ++press) {
    const double slope = (1 + kScatter * normal(random)) / kScatteredStiffness;
    for (int i = 0; i < 60; ++i) {
      const double force = 3.0 * i / 59;
      samples.push_back({press + i / 500., slope * force + 2e-5 * normal(random),
                         force + kForceSigma * normal(random), sigma});
    }
  }
  return samples;
}

// Two deviations hold the truth in 95 % even for few presses.
TEST(Compliance, DeviationIsWiderForFewPresses) {
  for (const int count : {2, 3, 5, 12}) {
    int held = 0, all = 0;
    for (std::uint32_t seed = 0; seed < 1500; ++seed) {
      const auto estimate = estimateCompliance(scatteredPresses(count, seed), kForceSigma, true);
      ASSERT_TRUE(estimate);
      ASSERT_EQ(estimate->loadings, static_cast<std::size_t>(count));
      held += std::abs(estimate->compliance - 1 / kScatteredStiffness) <
              2 * estimate->compliance_deviation;
      ++all;
    }
    const double share = static_cast<double>(held) / all; // its own deviation is .005
    std::printf("%d presses: two deviations hold the truth in %.3f\n", count, share);
    EXPECT_NEAR(share, 0.9545, 0.02) << count;
  }
}

// The interval's width is no standard deviation: squared, it would make the stiffness too low.
TEST(Compliance, StiffnessOfFewPressesIsUnbiased) {
  for (const int count : {2, 3, 5}) {
    constexpr int kSeeds = 3000;
    double mean = 0, variance = 0, stated = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const auto estimate = estimateCompliance(scatteredPresses(count, seed), kForceSigma, true);
      ASSERT_TRUE(estimate);
      mean += estimate->stiffness / kSeeds;
      variance += std::pow(estimate->compliance - 1 / kScatteredStiffness, 2) / kSeeds;
      stated += std::pow(estimate->standard_deviation, 2) / kSeeds;
    }
    std::printf("%d presses: stiffness %+.2f %%, stated / true variance %.2f\n", count,
                100 * (mean / kScatteredStiffness - 1), stated / variance);
    EXPECT_NEAR(mean / kScatteredStiffness, 1, 0.005); // its own deviation is .001
    EXPECT_NEAR(stated / variance, 1, 0.1);
  }
}

// Tables of Student's t: 13.968, 4.5266 and 3.3068 hold 95.45 % for 1, 2 and 3 degrees of freedom.
TEST(Compliance, FewPressesAreWidenedByStudentsT) {
  for (const auto& [count, quantile] : {std::pair(2, 13.968), {3, 4.5266}, {4, 3.3068}}) {
    const auto estimate = estimateCompliance(scatteredPresses(count, 1), kForceSigma, true);
    ASSERT_TRUE(estimate);
    EXPECT_NEAR(2 * estimate->compliance_deviation / estimate->standard_deviation, quantile,
                0.003 * quantile);
    EXPECT_NEAR(estimate->stiffness_deviation / estimate->stiffness,
                estimate->compliance_deviation / estimate->compliance, 1e-12);
  }
}

// The path states what the presses scatter by, so that their variances are averaged: here the
// error of a slope that lets two ends differ by sigma each, over 3 N. The ends of a loading are
// left out, up to a quarter of the range.
TEST(Compliance, ScatterOfPressesIsAveragedWithWhatThePathStates) {
  constexpr double kStated = 4; // the path is worth four presses
  const double slope_deviation = kScatter / kScatteredStiffness;
  const double sigma = slope_deviation * 3 / std::sqrt(2);
  for (const int count : {2, 3, 8}) {
    int held = 0;
    constexpr int kSeeds = 1500;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const auto scattered = estimateCompliance(scatteredPresses(count, seed), kForceSigma, true);
      const auto pooled =
          estimateCompliance(scatteredPresses(count, seed, sigma), kForceSigma, true);
      ASSERT_TRUE(scattered && pooled);
      const double own = count - 1, stated = slope_deviation * slope_deviation / count;
      const double expected = std::sqrt(
          (own * std::pow(scattered->standard_deviation, 2) + kStated * stated) / (own + kStated));
      EXPECT_GT(pooled->standard_deviation, 0.95 * expected) << count << " " << seed;
      EXPECT_LT(pooled->standard_deviation, 1.35 * expected) << count << " " << seed;
      held +=
          std::abs(pooled->compliance - 1 / kScatteredStiffness) < 2 * pooled->compliance_deviation;
    }
    std::printf("%d presses and the path: held in %.3f\n", count, held / double(kSeeds));
    EXPECT_GT(held / double(kSeeds), 0.9545 - 0.02) << count;
  }
}

// The contact begins with a rise of two samples, of which one is left, before a pause.
TEST(Compliance, ARiseWithoutASlopeIsNoPress) {
  constexpr double kSigma = 0.2e-3;
  std::vector<PressSample> press;
  for (int i = 0; i < 250; ++i)
    press.push_back({1 + i / 500., 3.0 * std::max(i - 20, 0) / 229 / 800,
                     3.0 * std::max(i - 20, 0) / 229, kSigma});
  std::vector<PressSample> all = {{0, 0, 0, kSigma}, {0.002, 0, 3, kSigma}};
  all.insert(all.end(), press.begin(), press.end());
  const auto alone = estimateCompliance(press, 0, true), found = estimateCompliance(all, 0, true);
  ASSERT_TRUE(alone && found);
  EXPECT_EQ(found->loadings, 1u);
  EXPECT_NEAR(found->stiffness / alone->stiffness, 1, 0.01);
  EXPECT_NEAR(found->compliance_deviation / alone->compliance_deviation, 1, 0.05);
  EXPECT_GT(found->compliance_deviation, kSigma / 3);
}

// Errors of the path last as long as a press and are stated.
TEST(Compliance, OnePressIsAsUncertainAsThePath) {
  constexpr double kSigma = 0.2e-3;
  for (const double stiffness : {300., 1000., 3000.}) {
    double squares = 0, stated = 0;
    constexpr int kSeeds = 400;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      std::vector<PressSample> samples;
      double error = kSigma * normal(random);
      const double stays = std::exp(-0.002 / 0.3);
      for (int i = 0; i < 250; ++i) {
        const double force = 3.0 * i / 249;
        error = stays * error + kSigma * std::sqrt(1 - stays * stays) * normal(random);
        samples.push_back(
            {i / 500., force / stiffness + error, force + kForceSigma * normal(random), kSigma});
      }
      const auto estimate = estimateCompliance(samples, kForceSigma, true);
      ASSERT_TRUE(estimate);
      ASSERT_EQ(estimate->loadings, 1u);
      squares += std::pow(estimate->compliance - 1 / stiffness, 2) / kSeeds;
      stated += estimate->compliance_deviation / kSeeds;
    }
    std::printf("one press, %.0f N/m: stated %.2f of the deviation\n", stiffness,
                stated / std::sqrt(squares));
    EXPECT_GT(stated, 0.9 * std::sqrt(squares));
    EXPECT_LT(stated, 2 * std::sqrt(squares));
  }
}

TEST(Compliance, IsAbsentWithoutALoading) {
  EXPECT_FALSE(estimateCompliance({}, kForceSigma));
  std::vector<PressSample> resting(500);
  for (std::size_t i = 0; i < resting.size(); ++i)
    resting[i] = {static_cast<double>(i) / 500, 0.001, 1.};
  EXPECT_FALSE(estimateCompliance(resting, kForceSigma));
  // Unloading alone gives no loading curve to fit.
  for (std::size_t i = 0; i < resting.size(); ++i)
    resting[i].force = 3 - 0.005 * static_cast<double>(i);
  EXPECT_FALSE(estimateCompliance(resting, kForceSigma));
}

TEST(Compliance, EachPressHasItsOwnZero) {
  std::vector<PressSample> samples = presses(1000, 0, 1, 0, true);
  for (PressSample& sample : samples) sample.displacement += 0.01 * std::floor(sample.t / 0.6);
  EXPECT_NEAR(estimateCompliance(samples, 0)->stiffness, 1000, 1e-6);
}

// Samples between two presses belong to no press.
TEST(Compliance, PauseEndsALoading) {
  std::vector<PressSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({i / 500., 1e-5 * i, 0.01 * i});
  for (int i = 0; i < 100; ++i) samples.push_back({1 + i / 500., 1 + 1e-5 * i, 1 + 0.01 * i});
  const auto estimate = estimateCompliance(samples, 0);
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->loadings, 2u);
  EXPECT_NEAR(estimate->stiffness, 1000, 1e-6);
}

} // namespace
} // namespace patina
