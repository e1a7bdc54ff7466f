// Samplers and layouts of the field against shapes with a known distance, and what follows from it:
// which sampler `high` is and how blocks are stored (docs/studies.md).
#pragma once

#include "app/studies/study.h"

namespace patina {

// Tables: value [m] and direction [deg] for sphere, torus and box by sampler and resolution; a
// sphere known only through triangles; layouts of the same field at one resolution. "order" is the
// fitted order of that row's sampler.
std::vector<WorkPrecisionTable> fieldStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
