// Painted material (K22, K23): its value by the grid, work round closed loops (F6), nanoseconds.
#pragma once

#include "app/studies/study.h"

namespace patina {

std::vector<WorkPrecisionTable> materialStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
