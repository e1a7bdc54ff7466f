// Friction in time: what a stroke to and fro takes, stick and slip, and which way friction points,
// against closed forms (MATH 2.6), by period and speed.
#pragma once

#include "app/studies/study.h"

namespace patina {

// Energy of a cycle (T-K09b), period of stick-slip (T-K09e), direction on a circle by the paper's
// slip and by displacement. ns is of one tick with friction; of stick-slip, device included.
std::vector<WorkPrecisionTable> frictionStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
