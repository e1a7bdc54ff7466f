// Fits a Fourier texture to a height profile (A18 to A21).
#pragma once

#include <optional>
#include <vector>

#include "acquisition/profile/height_profile.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

// Separates texture from low-frequency drift in a height profile. Drift lasts some tenths of a
// second, so its wavelength is proportional to the tip's speed; where the tip nearly stops, it
// appears as a spike.

// Returns the waviness of heights `step` apart [m] by P-splines (Eilers & Marx 1996): cubic splines
// with the least sum of squared residuals and third differences. Heights of weight 0 have no
// effect. A wave of wavelength l is passed by 1 / (1 + (length / l)^6); parabolas are passed
// completely, up to the ends. Weights are not negative, and at least three are above 0.
std::vector<double> wavinessOf(const std::vector<double>& heights,
                               const std::vector<double>& weights, double step, double length);

// Returns weights from 0 to 1 by the stroking speed of each height: 1/2 at a quarter of the median,
// as the variance of the heights falls with the cube of the speed. Throws Error if the tip is
// stationary on at least half of them.
std::vector<double> speedWeights(const std::vector<double>& speeds);

// Returns the heights without their waviness above `cutoff` [m], each times its weight; unknown
// heights are no texture, and the waviness bridges them.
std::vector<double> roughnessProfile(const std::vector<double>& heights,
                                     const std::vector<double>& speeds, double step, double cutoff);

struct FitOptions1d {
  int harmonics = 128;
  double blend = 0.01;        // blended zone at the end, relative to the length (seamless())
  std::optional<double> step; // sample spacing [m]; default: median of the points'
  // Wavelengths above this are shape, which the mesh has, and are removed [m]. With known speeds,
  // parts that were stroked too slowly are ignored.
  std::optional<double> cutoff{};
  // Smallest signal-to-noise ratio of a harmonic (harmonicNoise()); 0: all are kept.
  double min_snr = 0;
};

struct FittedTexture {
  FourierTexture texture;               // line texture of period `length`
  double length = 0;                    // length of the profile [m]
  std::size_t samples = 0;              // samples per period
  double tilt = 0;                      // slope of the removed line
  double rms = 0;                       // rms about the least-squares line [m]
  double variance = 0;                  // variance about the removed line [m^2]
  double residual = 0;                  // rms residual outside the blended zone [m]
  double removed_rms = 0;               // rms of the waviness removed by the cutoff [m]
  double blended = 0;                   // rms change by blending, over the whole profile [m]
  double noise = 0;                     // harmonicNoise() of the texture with all harmonics
  std::size_t suppressed_harmonics = 0; // harmonics removed by min_snr
};

// `points` may be in any order; those within a step are averaged, weighted by their sigmas if these
// are above 0. Removes a straight line, fitted together with the lowest harmonics. The number of
// harmonics is at most (samples - 1) / 2. Throws Error: fewer than three places, heights not finite
// or all equal, a gap longer than a twentieth of the length, a harmonic, blend or cutoff out of
// range.
FittedTexture fitTexture(const std::vector<ProfilePoint>& points, const FitOptions1d& options);

// Makes evenly sampled heights periodic; the last one is the first one of the next period. Adds a
// cubic over the last `blend` steps that matches value and slope at the beginning (A18). Slopes are
// those of one step. If the result exceeds the heights' range and these slopes are random, slopes
// over a quarter of the zone are used and the range is kept. Earlier heights are unchanged. `blend`
// is at least 2 and leaves the first two heights.
std::vector<double> seamless(std::vector<double> heights, std::size_t blend);

// Fourier coefficients of even heights over one period, the first not repeated: f = 2/M Re, -2/M Im
// of their transform; the Nyquist term counts once (A19, F12). The mean is not included.
FourierSeries seriesOf(const std::vector<double>& heights, int harmonics);

// Returns the noise of a harmonic of wavelength l, divided by l^2 [1/m]: heights are double
// integrals of white noise, so their noise grows as l^2. The median over the harmonics is noise if
// fewer than half of them are texture.
double harmonicNoise(const FourierTexture& line);

// Returns the cross-correlation of two lines (A21): h(x, y) = across(y) along(-x), with the rms of
// `across`. Both have the same period and number of harmonics; throws Error otherwise.
FourierTexture crossCorrelation(const FourierTexture& across, const FourierTexture& along);

// Returns a texture with these amplitudes and random phases from the seed.
FourierTexture spectrumOf(const FourierTexture& line, std::uint64_t seed);

} // namespace patina
