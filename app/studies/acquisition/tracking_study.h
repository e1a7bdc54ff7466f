// Error of a marker rig's pose against time a frame (A04), over distance, blur, noise and camera,
// and of a tip that is found by turning about it (A05).
#pragma once

#include "app/studies/study.h"

namespace patina {

// ns is of one frame; of the tip, of one fit.
std::vector<WorkPrecisionTable> trackingStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
