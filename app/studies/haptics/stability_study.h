// The closed loop against its theory: where it stops settling, how it bounces, what quietens it.
#pragma once

#include "app/studies/study.h"

namespace patina {

// Boundary against eigenvalues (MATH 2.1.2, 2.1.3), restitution against the damped half wave (F4),
// encoder against dry friction (F5), and the table of stabilisers (MATH 2.3); then
// surfaces that are no plane (loop_on_surfaces.h). ns is of one tick of the
// loop, device included.
std::vector<WorkPrecisionTable> stabilityStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
