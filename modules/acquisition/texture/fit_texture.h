// A profile of heights becomes a Fourier texture (A18 to A21).
#pragma once

#include <optional>
#include <vector>

#include "acquisition/profile/height_profile.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

struct FitOptions1d {
  int harmonics = 128;
  double blend = 0.01;        // of the profile's length, at its end (seamless())
  std::optional<double> step; // of the even samples [m]; else the median of the points'
  // Longer waves are the body's shape, which its mesh has, and are left out [m]. Where the points'
  // speeds are known, so is what was drawn over too slowly to be known (drawn_heights.h).
  std::optional<double> cutoff{};
  // Harmonics are left out that are not so many times as high as the noise (noiseOf()); 0: none.
  double over_noise = 0;
};

struct FittedTexture {
  FourierTexture texture;  // a line, of period `length`
  double length = 0;       // of the profile [m]
  std::size_t samples = 0; // even ones, in a period
  double tilt = 0;         // of the line that was taken off
  double rms = 0;          // of the profile off its least-squares line [m]
  double variance = 0;     // of the profile without the line that was taken off [m^2]
  double residual = 0;     // rms of what the texture lacks of that, where nothing was blended [m]
  double left_out = 0;     // rms of what the cutoff leaves out [m]
  double blended = 0;      // rms of what blending changed, over the whole [m]
  double noise = 0;        // noiseOf() the texture with all of its harmonics
  std::size_t quiet = 0;   // harmonics that over_noise left out
};

// points: in any order along the way; those within a step are one, by their sigmas where these are
// above 0. A straight line is taken off, the best one beside
// the lowest harmonics. Harmonics are no more than (samples - 1) / 2.
// Throws Error: fewer than three places, heights that are not finite or all equal, a gap of more
// than a twentieth of the length, a harmonic, blend or cutoff that is out of range.
FittedTexture fitTexture(const std::vector<ProfilePoint>& points, const FitOptions1d& options);

// Heights at even steps, the last of which is the first one of the next period: over the last
// `blend` of them a cubic is added that makes value and slope there those of the beginning (A18).
// The slopes are those of one step. Where that leaves the heights' range, and slopes of one step
// are chance, they are those of lines through a quarter of the zone, and the range is kept. What is
// before is not touched. blend: 2 or more, and not the first two heights.
std::vector<double> seamless(std::vector<double> heights, std::size_t blend);

// Coefficients of heights at even steps over one period, the first not repeated: f = 2/M Re, -2/M
// Im of their transform, the term at the Nyquist frequency once (A19, F12). The mean is apart.
FourierSeries seriesOf(const std::vector<double>& heights, int harmonics);

// What a harmonic of wavelength l would be without any texture, over l^2 [1/m]: heights come from
// two integrations of an even noise, so that it grows as the square, and of the harmonics' heights
// over l^2 the median is noise as long as fewer than half of them are texture.
double noiseOf(const FourierTexture& line);

// The cross-correlation of a line with another (A21): h(x, y) = across(y) along(-x), as high as
// `across` is (rms). Both of the same period and number of harmonics; throws Error.
FourierTexture crossCorrelation(const FourierTexture& across, const FourierTexture& along);

// Its amplitudes with phases of a seed.
FourierTexture spectrumOf(const FourierTexture& line, std::uint64_t seed);

} // namespace patina
