// Painting (K15-K18) and relief (K21, F8): coverage and weight, height and slope against closed
// forms, and what they cost.
#pragma once

#include "app/studies/study.h"

namespace patina {

std::vector<WorkPrecisionTable> paintStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
