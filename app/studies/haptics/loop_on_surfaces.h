// The closed loop where a surface has more than one normal, is curved like the tip's own depth, or
// carries relief or roughness.
#pragma once

#include "app/studies/study.h"

namespace patina {

// Where a small oscillation stops decaying, in N/m of the stiffest direction, against the
// eigenvalues of the loop: `error` in %. m = 0.1 kg, b = 0.5 N s/m, 1 kHz, no stabiliser.
WorkPrecisionTable loopLimitsOnSurfaces(const StudyOptions& options, Progress& progress);

// A mass pressed onto it: `error` is the rms velocity of the last second [m/s], `error_max` of the
// 2nd; "rests" is 1 below 1e-6 m/s in touch, "should rest" what theory or promise says.
WorkPrecisionTable restOnSurfaces(const StudyOptions& options, Progress& progress);

} // namespace patina
