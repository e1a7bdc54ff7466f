// Direct sums of a Fourier series and its slope at one phase (A19).
#pragma once

#include <vector>

#include "scene/fourier/fourier_texture.h"
#include "scene/fourier/series_value.h"

namespace patina {

// Computes a sine and a cosine for every term.
SeriesValue sumDirectly(const FourierSeries& series, double phase);

// Fills u(phase) and du/dphase of a plane's terms 1, cos, sin, cos 2, sin 2 ..., 2 N + 1 each.
void fillTerms(double phase, int harmonics, double* terms, double* slopes);

} // namespace patina
