// How a texture's harmonics differ from those of the true profile.
#pragma once

#include <vector>

#include "acquisition/profile/height_profile.h"
#include "scene/fourier/fourier_texture.h"

namespace patina {

struct SpectrumError {
  double wavelength = 0, true_wavelength = 0; // of the strongest wave [m]
  double amplitude = 0, true_amplitude = 0;   // of it [m]
  double decibels = 0;      // the largest of those compared, without a sign; of no stretch (below)
  double stretched = 0;     // the same, the stretch counted
  std::size_t compared = 0; // harmonics
};

// texture: a line; truth: heights along its period, in the order of their way, straight between
// them. Both are seen through one window that is smooth at the ends, so that nothing depends on how
// these were blended and a wave need not fit whole; nothing of the fit is used. Of the waves no
// longer than `longest` [m] those are compared that in the truth are higher than `floor` [1/m]
// times the square of their wavelength, and the highest one in any case. A way that is found too
// long or too short stretches the whole spectrum: that is the error of the strongest wave's length,
// and up to 1 % of it are not counted again in the others' heights. Throws
// std::invalid_argument: another kind of texture, fewer than two heights.
SpectrumError spectrumError(const FourierTexture& texture, const std::vector<ProfilePoint>& truth,
                            double longest, double floor);

} // namespace patina
