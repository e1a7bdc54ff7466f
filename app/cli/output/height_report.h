// What patina filter says of a scan's heights.
#pragma once

#include "acquisition/profile/scan_heights.h"
#include "app/cli/output/report.h"

namespace patina::cli {

// normal, stretches, height_sigma, roughness and stiffness, the last two where they are known.
void reportHeights(const ScanHeights& scan, Report& report);

} // namespace patina::cli
