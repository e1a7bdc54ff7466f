// Contact on shapes with more than one normal, proxy and ray in one row: force against the proxy on
// the exact distance (P01), what must not happen, and time.
#pragma once

#include "app/studies/study.h"

namespace patina {

// Rows by shape, grid and tip at 500 N/m. `error` is the 99th percentile of the proxy over ticks in
// contact, `error_max` the 99.9th, snaps apart; ns is the median of its tick. Columns of the ray
// begin with "ray". The order is that of the 99th percentile over the shapes with plane faces.
WorkPrecisionTable contactOnShapes(const StudyOptions& options, Progress& progress);

} // namespace patina
