// Profiles become Fourier textures (A18 to A21).
#include "acquisition/texture/fit_texture.h"

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "acquisition/simulation/simulated_surface.h"
#include "core/error.h"
#include "support/constants.h"
#include "support/shared_data.h"

namespace patina {
namespace {

using test::kPi;

std::vector<double> noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1e-5);
  std::vector<double> values(count);
  for (double& value : values) value = normal(random);
  return values;
}

std::vector<ProfilePoint> pointsOf(const std::vector<double>& heights, double step) {
  std::vector<ProfilePoint> points;
  for (std::size_t i = 0; i < heights.size(); ++i)
    points.push_back({static_cast<double>(i) * step, heights[i], 0});
  return points;
}

FourierTexture lineOf(const FourierSeries& series, double length) {
  FourierTexture texture;
  texture.omega = 2 * kPi / length;
  texture.series = series;
  texture.series.mean = 0;
  texture.low = minHeight(texture);
  return texture;
}

// T-A18
TEST(Seamless, EndsMeetWithOneSlopeAndNothingElseIsTouched) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<double> heights = noise(400, seed);
    for (int i = 0; i < 400; ++i) heights[static_cast<std::size_t>(i)] += 1e-3 * std::sin(0.03 * i);
    for (const std::size_t blend : {2u, 7u, 40u, 398u}) {
      const std::vector<double> closed = seamless(heights, blend);
      ASSERT_EQ(closed.size(), heights.size());
      EXPECT_EQ(closed.back(), closed.front());
      const double first = closed[1] - closed[0], last = closed[399] - closed[398];
      if (blend < 40) {
        EXPECT_NEAR(first, last, 1e-15);
      }
      for (std::size_t i = 0; i + blend < closed.size(); ++i) EXPECT_EQ(closed[i], heights[i]);
    }
  }
  EXPECT_THROW(seamless({0, 1, 2}, 2), Error);
  EXPECT_THROW(seamless({0, 1, 2, 3, 4}, 1), Error);
  EXPECT_THROW(seamless({0, 1, 2, 3, 4}, 4), Error);
}

// T-A18: slopes over one step of a rough profile are random; a long zone would create hills.
TEST(Seamless, NeverLeavesTheRangeOfTheProfile) {
  for (unsigned seed = 0; seed < 20; ++seed)
    for (const std::size_t blend : {8u, 40u, 400u, 800u}) {
      const std::vector<double> heights = noise(4000, seed);
      const std::vector<double> closed = seamless(heights, blend);
      const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
      const auto [low, high] = std::minmax_element(closed.begin(), closed.end());
      EXPECT_GE(*low, *least);
      EXPECT_LE(*high, *most);
      EXPECT_EQ(closed.back(), closed.front());
      double changed = 0, square = 0;
      for (std::size_t i = 0; i < heights.size(); ++i) {
        changed += (closed[i] - heights[i]) * (closed[i] - heights[i]);
        square += heights[i] * heights[i];
      }
      EXPECT_LT(changed, square);
    }
}

// T-A18: truncation falls with N^-2.5 once the ends meet with one slope, with N^-.5 at a jump.
TEST(Seamless, LetsTheSeriesConverge) {
  std::vector<double> heights;
  for (int i = 0; i <= 4000; ++i) {
    const double x = i / 4000.0;
    heights.push_back(1e-4 * (std::exp(-x) + std::sin(2 * x)));
  }
  const auto truncation = [](std::vector<double> period, int n) {
    period.pop_back();
    const FourierSeries all = seriesOf(period, 1500);
    double rest = 0;
    for (std::size_t j = static_cast<std::size_t>(n); j < all.a.size(); ++j)
      rest += 0.5 * (all.a[j] * all.a[j] + all.b[j] * all.b[j]);
    return std::sqrt(rest);
  };
  const std::vector<double> closed = seamless(heights, 2000);
  EXPECT_GT(std::log2(truncation(closed, 16) / truncation(closed, 32)), 2.35);
  EXPECT_GT(std::log2(truncation(closed, 32) / truncation(closed, 64)), 2.35);
  EXPECT_NEAR(std::log2(truncation(heights, 16) / truncation(heights, 32)), 0.5, 0.1);
}

// T-A19a, T-A19c
TEST(SeriesOfHeights, ReproducesSamplesAndKeepsTheirVariance) {
  const std::vector<double> heights = noise(257, 1);
  const FourierSeries series = seriesOf(heights, 128);
  const FourierTexture texture = lineOf(series, 0.0257);
  double variance = 0, parseval = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = 0.0257 * static_cast<double>(i) / 257;
    EXPECT_NEAR(height(texture, x) + series.mean, heights[i], 1e-12 * 1e-5 * 100);
    variance += (heights[i] - series.mean) * (heights[i] - series.mean) / 257;
  }
  for (std::size_t j = 0; j < 128; ++j)
    parseval += 0.5 * (series.a[j] * series.a[j] + series.b[j] * series.b[j]);
  EXPECT_NEAR(parseval, variance, 1e-12 * variance);
}

TEST(SeriesOfHeights, CountsTheNyquistTermOnce) {
  std::vector<double> heights;
  for (int i = 0; i < 256; ++i) heights.push_back(i % 2 ? -1e-4 : 1e-4);
  const FourierSeries series = seriesOf(heights, 128);
  EXPECT_NEAR(series.a[127], 1e-4, 1e-17);
  EXPECT_EQ(series.b[127], 0);
  EXPECT_THROW(seriesOf(heights, 129), Error);
}

// T-A19b: an asymmetric profile comes back the right way round and as high as it was.
TEST(SeriesOfHeights, AreNeitherMirroredNorScaled) {
  const std::size_t m = 401;
  std::vector<double> heights;
  for (std::size_t i = 0; i < m; ++i) {
    const double u = 2 * kPi * static_cast<double>(i) / m;
    heights.push_back(3e-5 * std::cos(2 * u) - 1e-5 * std::sin(5 * u) + 2e-5 * std::sin(u));
  }
  const FourierSeries series = seriesOf(heights, 8);
  EXPECT_NEAR(series.a[1], 3e-5, 1e-18);
  EXPECT_NEAR(series.b[4], -1e-5, 1e-18);
  EXPECT_NEAR(series.b[0], 2e-5, 1e-18);
}

// T-A20
TEST(FitTexture, FiveWavesAreTheFifthHarmonicOfTheLength) {
  std::vector<ProfilePoint> points;
  const double length = 0.037;
  for (int i = 0; i <= 1000; ++i) {
    const double x = length * i / 1000;
    points.push_back({0.2 + x, 1e-4 * std::sin(10 * kPi * x / length), 0});
  }
  const FittedTexture fitted = fitTexture(points, {128, 0.002, {}});
  EXPECT_NEAR(fitted.texture.omega, 2 * kPi / length, 1e-9);
  EXPECT_NEAR(fitted.length, length, 1e-15);
  double others = 0;
  for (std::size_t j = 0; j < 128; ++j) {
    const double amplitude = std::hypot(fitted.texture.series.a[j], fitted.texture.series.b[j]);
    if (j != 4) others = std::max(others, amplitude);
  }
  EXPECT_NEAR(fitted.texture.series.b[4], 1e-4, 1e-15);
  EXPECT_LT(others, 1e-15);
  EXPECT_NEAR(height(fitted.texture, 0.01), height(fitted.texture, 0.01 + length), 1e-15);
  EXPECT_NEAR(fitted.texture.low, -1e-4, 1e-9);
}

TEST(FitTexture, WavesLongerThanTheCutoffAreLeftOut) {
  const FourierTexture truth =
      lineOf({0, {5e-4, 0, 0, 1e-5, 2e-5, 0}, {0, 0, 1e-4, 0, 0, 3e-6}}, 0.04);
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= 800; ++i) points.push_back({5e-5 * i, height(truth, 5e-5 * i), 0});
  // The fourth wave is as long as the cutoff and stays.
  const FittedTexture fitted = fitTexture(points, {6, 0.01, {}, 0.01});
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_NEAR(fitted.texture.series.a[j], j < 3 ? 0 : truth.series.a[j], 1e-8) << j;
    EXPECT_NEAR(fitted.texture.series.b[j], j < 3 ? 0 : truth.series.b[j], 1e-8) << j;
  }
  EXPECT_NEAR(fitted.removed_rms, std::sqrt(0.5 * (25e-8 + 1e-8)), 1e-7);
  EXPECT_THROW(fitTexture(points, {6, 0.01, {}, 1e-3}), Error);
}

TEST(FitTexture, RecoversTheTextureFromUnevenNoisyPoints) {
  const FourierTexture truth =
      lineOf({0, {2e-5, 0, 0, 1e-5, 0, 0, 0, 3e-6}, {0, 1e-5, 0, 0, 0, 5e-6, 0, 0}}, 0.04);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(0, 0.04);
  std::normal_distribution<double> error(0, 4e-6);
  std::vector<ProfilePoint> points = {{0, 2e-3 + height(truth, 0), 4e-6},
                                      {0.04, 2.4e-3 + height(truth, 0), 4e-6}};
  for (int i = 0; i < 20000; ++i) {
    const double x = place(random);
    points.push_back({x, 2e-3 + 0.01 * x + height(truth, x) + error(random), 4e-6});
  }
  const FittedTexture fitted = fitTexture(points, {8, 0.02, 0.2e-3});
  for (std::size_t j = 0; j < 8; ++j) {
    const double due = std::hypot(truth.series.a[j], truth.series.b[j]),
                 got = std::hypot(fitted.texture.series.a[j], fitted.texture.series.b[j]);
    EXPECT_NEAR(got, due, 1e-6) << j;
  }
  EXPECT_NEAR(fitted.tilt, 0.01, 1e-3);
}

// The remaining truncation error is the power of the higher harmonics.
TEST(FitTexture, ErrorFallsAsHarmonicsAreAdded) {
  const std::vector<double> heights = milledProfile(3, 0.05, 2e-5);
  double before = 1e9, first = 0;
  for (const int n : {4, 16, 64, 256, 1000}) {
    const FittedTexture fitted = fitTexture(pointsOf(heights, 2e-5), {n, 0.05, {}});
    EXPECT_LT(fitted.residual, before);
    before = fitted.residual;
    if (n == 4) first = before;
  }
  EXPECT_LT(before, 0.05 * first);
}

// A ten times longer zone would add a bump of more than the rms where the cubic meets the slope of
// the beginning.
TEST(FitTexture, BlendsLittleByDefault) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const std::vector<ProfilePoint> points = pointsOf(milledProfile(seed, 28e-3, 5e-6), 5e-6);
    const FittedTexture fitted = fitTexture(points, {});
    EXPECT_LE(fitted.blended, 0.2 * std::sqrt(fitted.variance)) << seed;
    EXPECT_LE(fitted.residual, 0.15 * std::sqrt(fitted.variance)) << seed;
  }
}

TEST(FitTexture, ResidualMatchesTheSpectrumOfTheSharedMilledSurface) {
  const std::filesystem::path path = test::sharedData("profiles/npl_mill.xml");
  PATINA_SKIP_WITHOUT(path);
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string open = "<DATA_POINT_VALUES>";
  std::istringstream numbers(text.substr(text.find(open) + open.size()));
  std::vector<double> heights;
  for (double height; numbers >> height;) heights.push_back(1e-6 * height);
  ASSERT_EQ(heights.size(), 22401u);
  const FittedTexture fitted = fitTexture(pointsOf(heights, 0.25e-6), {128, 0.01, {}});
  std::printf("milled, 128 harmonics: relative rms %.4f, blended %.4f\n",
              fitted.residual / std::sqrt(fitted.variance),
              fitted.blended / std::sqrt(fitted.variance));
  EXPECT_LE(fitted.residual / std::sqrt(fitted.variance), 0.105);
}

// T-A21a
TEST(CrossCorrelation, IsTheProductOfTwoCosines) {
  const FourierTexture wave = lineOf({0, {0, 1e-4, 0}, {0, 0, 0}}, 0.02);
  const FourierTexture crossed = crossCorrelation(wave, wave);
  ASSERT_EQ(crossed.products.size(), 1u); // rank one
  for (int i = 0; i < 100; ++i) {
    const double x = 1.7e-4 * i, y = 3.1e-4 * i - 0.01, w = 2 * 2 * kPi / 0.02;
    // The height is that of the single wave: 1e-4 / sqrt(2) rms instead of half for a product.
    EXPECT_NEAR(height(crossed, x, y), 1e-4 * std::sqrt(2) * std::cos(w * x) * std::cos(w * y),
                1e-18);
  }
}

// T-A21b, against the correlation summed over the samples.
TEST(CrossCorrelation, MatchesTheSamplesAtTheHeightOfTheLine) {
  const std::size_t m = 65;
  const std::vector<double> p = noise(m, 5), q = noise(m, 6);
  const double length = 0.0065;
  const FourierTexture across = lineOf(seriesOf(p, 32), length),
                       along = lineOf(seriesOf(q, 32), length);
  const FourierTexture crossed = crossCorrelation(across, along);
  EXPECT_NEAR(rmsHeight(crossed), rmsHeight(across), 1e-12 * rmsHeight(across));
  // C(y, x) = p(y) q(-x) in the spatial domain, up to the factor that makes it a height.
  double most = 0, scale = rmsHeight(along);
  double mean_p = 0, mean_q = 0;
  for (std::size_t i = 0; i < m; ++i) {
    mean_p += p[i] / m;
    mean_q += q[i] / m;
  }
  for (std::size_t i = 0; i < m; i += 3)
    for (std::size_t j = 0; j < m; j += 3) {
      const double due = (p[j] - mean_p) * (q[(m - i) % m] - mean_q) / scale;
      const double got =
          height(crossed, length * static_cast<double>(i) / m, length * static_cast<double>(j) / m);
      most = std::max(most, std::abs(got - due));
    }
  EXPECT_LT(most, 1e-11 * 1e-5 * 100);
  EXPECT_THROW(crossCorrelation(across, lineOf(seriesOf(q, 31), length)), Error);
  EXPECT_THROW(crossCorrelation(across, lineOf(seriesOf(q, 32), 2 * length)), Error);
}

TEST(SpectrumOf, KeepsAmplitudesForAnySeed) {
  const FourierTexture line = lineOf(seriesOf(noise(101, 2), 50), 0.01);
  for (const std::uint64_t seed : {1u, 2u}) {
    const FourierTexture spectrum = spectrumOf(line, seed);
    EXPECT_EQ(problemOf(spectrum), "");
    EXPECT_NEAR(rmsHeight(spectrum), rmsHeight(line), 1e-12 * rmsHeight(line));
  }
  EXPECT_NE(height(spectrumOf(line, 1), 1e-3), height(spectrumOf(line, 2), 1e-3));
}

TEST(FitTexture, NamesTheFault) {
  const auto failure = [](std::vector<ProfilePoint> points, const FitOptions1d& options = {}) {
    try {
      fitTexture(points, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::vector<ProfilePoint> good = pointsOf(noise(300, 4), 1e-4);
  EXPECT_EQ(failure(good), "");
  EXPECT_NE(failure({}).find("fewer than three"), std::string::npos);
  EXPECT_NE(failure({{0, 1, 0}, {0, 2, 0}, {0, 3, 0}}).find("no length"), std::string::npos);
  EXPECT_NE(failure(pointsOf(std::vector<double>(50, 2e-3), 1e-4)).find("flat"), std::string::npos);
  std::vector<ProfilePoint> bad = good;
  bad[7].height = std::nan("");
  EXPECT_NE(failure(bad).find("not finite"), std::string::npos);
  bad = good;
  bad.erase(bad.begin() + 100, bad.begin() + 130);
  EXPECT_NE(failure(bad).find("no height between 9.9 mm and 13 mm"), std::string::npos)
      << failure(bad);
  EXPECT_NE(failure(good, {0, 0.1, {}}), "");
  EXPECT_NE(failure(good, {128, 0.7, {}}), "");
  EXPECT_NE(failure(good, {128, 0.1, -1.}), "");
  // Fewer harmonics where there are fewer samples.
  EXPECT_EQ(fitTexture(pointsOf(noise(21, 4), 1e-4), {128, 0.1, {}}).texture.series.a.size(), 9u);
}

} // namespace
} // namespace patina
