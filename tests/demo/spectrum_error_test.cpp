#include "demo/truth_errors.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/texture/fit_texture.h"

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// The length need not be a multiple of the wavelength.
std::vector<ProfilePoint> waves(double length, double height, double more = 0) {
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= 1000; ++i) {
    const double x = 0.05 * i / 1000;
    points.push_back(
        {0.01 + x,
         height * std::cos(kTwoPi * x / length) + more * std::cos(kTwoPi * x / (0.43 * length) + 1),
         0});
  }
  return points;
}

SpectrumError between(const std::vector<ProfilePoint>& measured,
                      const std::vector<ProfilePoint>& truth, double floor) {
  return spectrumError(fitTexture(measured, {}).texture, truth, 8e-3, floor);
}

TEST(SpectrumError, FindsAWaveBetweenTwoHarmonics) {
  for (const double length : {5e-3, 4.9e-3, 4.76e-3, 3.33e-3}) {
    const SpectrumError error = between(waves(length, 1e-4), waves(length, 1e-4), 1);
    EXPECT_NEAR(error.true_wavelength, length, 2e-4 * length);
    EXPECT_NEAR(error.true_amplitude, 1e-4, 1e-6);
    EXPECT_NEAR(error.wavelength, length, 1e-3 * length);
    EXPECT_LT(error.decibels, 0.1);
  }
}

TEST(SpectrumError, IsInDecibelsOfTheWorstHarmonic) {
  const auto truth = waves(5e-3, 1e-4, 4e-5);
  // 1.5/m: of waves of 5 mm above 38 um, of 2 mm above 7 um.
  const SpectrumError error = between(waves(5e-3, 1e-4, 5.2e-5), truth, 1.5);
  EXPECT_NEAR(error.decibels, 20 * std::log10(1.3), 0.15);
  EXPECT_GE(error.harmonic_count, 2u);
  const SpectrumError highest = between(waves(5e-3, 1e-4, 5.2e-5), truth, 1e3);
  EXPECT_EQ(highest.harmonic_count, 1u) << "the highest in any case";
  EXPECT_LT(highest.decibels, 0.1);
}

TEST(SpectrumError, DetectsAWrongWavelengthAndAMissingWave) {
  const SpectrumError error = between(waves(4.9e-3, 1e-4), waves(5e-3, 1e-4), 1);
  EXPECT_NEAR(error.wavelength / error.true_wavelength, 0.98, 2e-3);
  EXPECT_GT(between(waves(3e-3, 1e-4), waves(5e-3, 1e-4), 1).decibels, 20);
}

// The 25th of its harmonics is then a quarter of a harmonic away.
TEST(SpectrumError, CountsAUniformStretchAsAnErrorOfTheWavelengthOnly) {
  const auto truth = waves(5e-3, 1e-4, 4e-5);
  for (const double stretch : {0.991, 1.009}) {
    const SpectrumError error = between(waves(stretch * 5e-3, 1e-4, 4e-5), truth, 1.5);
    EXPECT_NEAR(error.wavelength / error.true_wavelength, stretch, 1e-3);
    EXPECT_LT(error.decibels, 0.3);
  }
  EXPECT_LT(between(waves(1.011 * 5e-3, 1e-4, 4e-5), truth, 1.5).decibels, 1) << "no cliff";
  EXPECT_GT(between(waves(0.96 * 5e-3, 1e-4, 4e-5), truth, 1.5).decibels, 2) << "another wave";
}

TEST(SpectrumError, AcceptsLinesAndHeights) {
  const FourierTexture line = fitTexture(waves(5e-3, 1e-4), {}).texture;
  EXPECT_THROW(spectrumError(crossCorrelation(line, line), waves(5e-3, 1e-4), 8e-3, 1),
               std::invalid_argument);
  EXPECT_THROW(spectrumError(line, {}, 8e-3, 1), std::invalid_argument);
}

} // namespace
} // namespace patina
