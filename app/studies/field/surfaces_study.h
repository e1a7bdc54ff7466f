// Offset, magnetic and merged surfaces (K12-K14): force and depth against closed forms, work round
// closed loops (T-ENER), and nanoseconds a tick.
#pragma once

#include "app/studies/study.h"
#include "core/types.h"

namespace patina {

std::vector<WorkPrecisionTable> surfacesStudy(const StudyOptions& options, Progress& progress);

// Depth of a point inside the union of two spheres of radius R at x = +-a, 0 < a < R: to the nearer
// point of the union's own surface, on a sphere or on the circle where the two meet (F9).
double lensDepth(const Vec3& p, double radius, double a);

} // namespace patina
