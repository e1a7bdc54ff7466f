// Error of filtered paths against run time (A06, A07): camera alone and fused with the probe, clean
// and with faults; height from acceleration by speed; stiffness from noisy presses.
#pragma once

#include "app/studies/study.h"

namespace patina {

// ns is of one second of scan; of stiffness, of one estimate.
std::vector<WorkPrecisionTable> filterStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
