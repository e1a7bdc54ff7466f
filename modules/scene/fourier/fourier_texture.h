// Texture as a sum of harmonics (A19, A21): what a profile or a height image becomes and what the
// hand feels of it. A plain value; texture_evaluator.h is what a tick of the servo asks.
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

// p(y) q(x), of which p bears the unit or both do: only their product is a height [m].
struct FourierProduct {
  FourierSeries along_x, along_y;
  bool operator==(const FourierProduct&) const = default;
};

enum class TextureKind {
  line,     // h(x): `series`
  spectrum, // h(x) of known amplitudes, phases drawn from `seed`: `series.a` >= 0, no b
  products, // h(x, y) = sum of `products` (A21); one of them is the cross-correlation's form
  plane     // h(x, y): `plane`
};

// h repeats itself every 2 pi / omega along x and y and has no mean: what means and products of
// means would add is left out.
struct FourierTexture {
  std::string name;
  TextureKind kind = TextureKind::line;
  double omega = 0;                     // fundamental [rad/m]; exact as it stands here
  FourierSeries series;                 // [m]
  std::vector<FourierProduct> products; // all of N harmonics
  // Square of 2 N + 1 rows and columns, row upon row [m]: h = u(y)' plane u(x), where u = 1, cos,
  // sin, cos 2, sin 2 ... of the phase.
  std::vector<double> plane;
  std::uint64_t seed = 0;           // of the spectrum's phases
  double low = 0;                   // least height over a period [m]: h - low >= 0
  std::optional<double> compliance; // of the material under it [m/N], where it was measured
  bool operator==(const FourierTexture&) const = default;
};

// More would take seconds and gigabytes to look at.
inline constexpr int kMostHarmonics = 1024, kMostPlaneHarmonics = 256; // over x; over x and y

// One line each, ending without a stop; empty where all is well: lengths that do not agree, values
// that are not finite, omega <= 0, compliance <= 0, a low above the mean, too many
// harmonics.
std::string problemOf(const FourierTexture& texture);

// N. Of a texture without a problem, as all that follows.
int harmonics(const FourierTexture& texture);
double period(const FourierTexture& texture); // 2 pi / omega [m]

// The series of a line; of a spectrum the one that its seed draws, the same on every machine.
FourierSeries seriesOf(const FourierTexture& texture);

// Term by term, slow and exact to rounding; x, y [m] as exactPhase() takes them. A line and a
// spectrum do not depend on y.
double height(const FourierTexture& texture, double x, double y = 0);
Vec2 gradient(const FourierTexture& texture, double x, double y = 0); // by x and y
double slope(const FourierTexture& texture, double x);                // dh/dx at y = 0

// What `low` is to be: the least of 16 samples a shortest wavelength (8 along each axis in two
// dimensions), followed down to its bottom.
double leastHeight(const FourierTexture& texture);

// Root mean square over a period, of the height [m] and of its gradient's length, by Parseval.
double rmsHeight(const FourierTexture& texture);
double rmsSlope(const FourierTexture& texture);

} // namespace patina
