// Compares a rendered force along a path, and a texture's harmonics, with the true ones.
#pragma once

#include <functional>
#include <vector>

#include "acquisition/profile/height_profile.h"
#include "core/types.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

// Height of the true surface over the plane.
using HeightOver = std::function<double(const Vec2&)>; // [m]

// Reference force of a surface of known height, found by search over its points, which shares no
// code with field, contact and textures: that of a frictionless spring of `stiffness` [N/m] from
// the nearest surface point; zero above the surface. Searches up to `reach` [m] to each side, where
// the nearest point must be.
Vec3 referenceForce(const HeightOver& surface, const Vec3& tip, double stiffness, double reach);

// Compares a texture's harmonics with those of the true profile.
struct SpectrumError {
  double wavelength = 0, true_wavelength = 0; // strongest wave [m]
  double amplitude = 0, true_amplitude = 0;   // strongest wave [m]
  double decibels = 0;            // largest absolute amplitude error, without the scale error
  double with_scale_error = 0;    // the same with the scale error
  std::size_t harmonic_count = 0; // number of harmonics compared
};

// Compares the harmonics of a 1D texture with those of the true profile (heights along its period
// in order, interpolated linearly) after the same smooth window, so that blended ends do not
// matter. Only wavelengths up to `longest` [m] whose true amplitude exceeds `floor` [1/m] times the
// squared wavelength are compared, and always the strongest. A common scale error of the
// wavelengths is reported once, as that of the strongest wave, and up to 1 % of it is removed from
// the other errors. Throws std::invalid_argument for another kind of texture or fewer than two
// heights.
SpectrumError spectrumError(const FourierTexture& texture, const std::vector<ProfilePoint>& truth,
                            double longest, double floor);

struct ForcePoint {
  double along = 0;                               // [m], ascending
  Vec3 outward = Vec3::UnitZ();                   // unit normal of the surface without texture
  Vec3 felt = Vec3::Zero(), truth = Vec3::Zero(); // [N]
};

struct ForceError {
  double relative_error = 0; // rms of the difference over rms of the truth
  double texture_error = 0;  // the same for the part along `outward`, minus its mean in each window
  double spatial_lag = 0;    // largest of all windows, along the path [m]
  double true_variation = 0; // rms [N]
  std::size_t windows = 0;
};

// Evaluates windows of length `window` [m], each shifted along the path by the best lag up to
// `max_lag` [m]; a shorter rest is ignored. Throws Error if there is no window.
ForceError forceError(const std::vector<ForcePoint>& points, double window = 10e-3,
                      double max_lag = 0.5e-3);

} // namespace patina
