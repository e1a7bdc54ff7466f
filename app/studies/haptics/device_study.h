// A device at the wire: how finely it says and pushes, how steadily it turns, how stiff it can be.
#pragma once

#include "app/studies/study.h"

namespace patina {

// The emulated Falcon under its real driver: one count and one motor value over the workspace;
// round trips and ages in real time, with and without faults on the wire (ns: of a turn); where a
// wall begins to buzz against eigenvalues, with backlash and dry friction besides; and what is
// displayed of stiffnesses up to 1e5 N/m behind the coupling.
std::vector<WorkPrecisionTable> deviceStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
