// How the harmonics of a texture differ from those of the true profile.
#pragma once

#include "scene/fourier/fourier_texture.h"

namespace patina {

struct SpectrumError {
  double wavelength = 0, true_wavelength = 0; // of the strongest wave [m]
  double amplitude = 0, true_amplitude = 0;   // of it [m]
  double decibels = 0;      // the largest of the harmonics above the floor, without a sign
  std::size_t compared = 0; // harmonics above it in the truth
};

// Both lines of one period; harmonics are compared that in the truth are higher than `floor` [1/m]
// times the square of their wavelength, and the highest one in any case. A wave may lie between two
// harmonics. Throws std::invalid_argument for other kinds.
SpectrumError spectrumError(const FourierTexture& texture, const FourierTexture& truth,
                            double floor);

} // namespace patina
