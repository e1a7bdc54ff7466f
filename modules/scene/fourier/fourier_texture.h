// Texture as a sum of harmonics (A19, A21), fitted to a profile or a height image. A plain value;
// the servo evaluates it by texture_evaluator.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

// f = mean + sum over j = 1 .. N of a[j-1] cos(j phase) + b[j-1] sin(j phase).
struct FourierSeries {
  double mean = 0;
  std::vector<double> a, b; // equally long
  bool operator==(const FourierSeries&) const = default;
};

// p(y) q(x). Only the product is a height [m].
struct FourierProduct {
  FourierSeries along_x, along_y;
  bool operator==(const FourierProduct&) const = default;
};

enum class TextureKind {
  line,     // 1D, h(x): `series`
  spectrum, // random phase, h(x): amplitudes `series.a` >= 0, no b, phases drawn from `seed`
  products, // separable, h(x, y) = sum of `products` (A21), such as a cross-correlation
  plane     // 2D, h(x, y): `plane`
};

// h is periodic with 2 pi / omega along x and y and has zero mean: constant terms of means and of
// products of means are ignored.
struct FourierTexture {
  std::string name;
  TextureKind kind = TextureKind::line;
  double omega = 0;                     // fundamental [rad/m]; exact as stored
  FourierSeries series;                 // [m]
  std::vector<FourierProduct> products; // each with N harmonics
  // Square of 2 N + 1 rows and columns, row by row [m]: h = u(y)' plane u(x), with u = 1, cos, sin,
  // cos 2, sin 2 ... of the phase.
  std::vector<double> plane;
  std::uint64_t seed = 0;           // seed of the spectrum's phases
  double low = 0;                   // minimum height over a period [m]: h - low >= 0
  std::optional<double> compliance; // [m/N] of the material underneath, if measured
  bool operator==(const FourierTexture&) const = default;
};

// Larger numbers would take seconds and gigabytes to evaluate.
inline constexpr int kMaxHarmonics = 1024, kMaxPlaneHarmonics = 256; // over x; over x and y

// Returns a one-line description of the first fault, without a full stop, or an empty text. Faults:
// unequal lengths, values that are not finite, omega <= 0, compliance <= 0, `low` above the mean,
// too many harmonics.
std::string problemOf(const FourierTexture& texture);

// Returns N. This and the functions below require a texture without a fault.
int harmonics(const FourierTexture& texture);
double period(const FourierTexture& texture); // 2 pi / omega [m]

// Returns the series of a line, or the one that a spectrum's seed draws, the same on every machine.
FourierSeries seriesOf(const FourierTexture& texture);

// Sums term by term: slow and exact to rounding; x, y [m] as for reducePhase(). Lines and spectra
// do not depend on y.
double height(const FourierTexture& texture, double x, double y = 0);
Vec2 gradient(const FourierTexture& texture, double x, double y = 0); // dh/dx, dh/dy
double slope(const FourierTexture& texture, double x);                // dh/dx at y = 0

// Computes `low`: the least of 16 samples per shortest wavelength (8 along each axis in 2D),
// refined to the local minimum.
double minHeight(const FourierTexture& texture);

// Root mean square over a period of the height [m] and of its gradient's length, by Parseval.
double rmsHeight(const FourierTexture& texture);
double rmsSlope(const FourierTexture& texture);

} // namespace patina
