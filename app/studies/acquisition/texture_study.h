// Fourier textures: what a number of harmonics lacks of a profile and what blending its end costs
// (A18, A19); what one evaluation takes and errs by, form by form (A20, A21).
#pragma once

#include "app/studies/study.h"

namespace patina {

// ns is of one fit; of forms, of one height and gradient. Errors are parts of the rms height.
std::vector<WorkPrecisionTable> textureStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
