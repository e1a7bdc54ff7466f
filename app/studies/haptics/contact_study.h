// The contact step, proxy beside ray, on the fixed test (contact_test_path.h): force against its
// closed form, and nanoseconds a tick, by surface, sampler, tip and friction; cracks; scale; order
// of the VCP (T-K06b). Last, shapes with more than one normal (contact_on_shapes.h).
#pragma once

#include "app/studies/study.h"

namespace patina {

std::vector<WorkPrecisionTable> contactStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
