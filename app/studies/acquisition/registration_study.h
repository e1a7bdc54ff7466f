// How well and how fast a path finds its place on a mesh (A10): methods over first guess, noise and
// outliers; convergence; number of points. Truth is the pose from which each path was moved.
#pragma once

#include "app/studies/study.h"

namespace patina {

// ns is of one registration; of convergence, of so many iterations.
std::vector<WorkPrecisionTable> registrationStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
