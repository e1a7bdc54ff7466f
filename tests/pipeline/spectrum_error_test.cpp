#include "pipeline/spectrum_error.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/texture/fit_texture.h"

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// Of a length that the wave does not fit whole.
FourierTexture waves(double length, double height, double more = 0) {
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= 1000; ++i) {
    const double x = 0.05 * i / 1000;
    points.push_back(
        {x,
         height * std::cos(kTwoPi * x / length) + more * std::cos(kTwoPi * x / (0.43 * length) + 1),
         0});
  }
  FitOptions1d options;
  options.cutoff = 8e-3; // what was taken for a tilt
  return fitTexture(points, options).texture;
}

TEST(SpectrumError, FindsAWaveBetweenTwoHarmonics) {
  for (const double length : {5e-3, 4.9e-3, 4.76e-3, 3.33e-3}) {
    const SpectrumError error = spectrumError(waves(length, 1e-4), waves(length, 1e-4), 1);
    EXPECT_NEAR(error.true_wavelength, length, 2e-3 * length);
    EXPECT_NEAR(error.true_amplitude, 1e-4, 2e-6);
    EXPECT_EQ(error.decibels, 0);
  }
}

TEST(SpectrumError, IsInDecibelsOfTheWorstHarmonic) {
  const FourierTexture truth = waves(5e-3, 1e-4, 4e-5);
  FourierTexture found = truth;
  for (std::size_t j = 15; j < found.series.a.size(); ++j) {
    found.series.a[j] *= 1.3;
    found.series.b[j] *= 1.3;
  }
  // 1.5/m: of waves of 5 mm above 38 um, of 2 mm above 6 um.
  const SpectrumError error = spectrumError(found, truth, 1.5);
  EXPECT_NEAR(error.decibels, 20 * std::log10(1.3), 1e-9);
  EXPECT_GE(error.compared, 2u);
  EXPECT_EQ(spectrumError(found, truth, 1e3).compared, 1u) << "the highest in any case";
  EXPECT_LT(spectrumError(found, truth, 1e3).decibels, 1e-9);
}

TEST(SpectrumError, SeesAWrongWavelength) {
  const SpectrumError error = spectrumError(waves(4.9e-3, 1e-4), waves(5e-3, 1e-4), 1);
  EXPECT_NEAR(error.wavelength / error.true_wavelength, 0.98, 2e-3);
}

TEST(SpectrumError, IsOfLines) {
  const FourierTexture line = waves(5e-3, 1e-4);
  EXPECT_THROW(spectrumError(crossCorrelation(line, line), line, 1), std::invalid_argument);
}

} // namespace
} // namespace patina
