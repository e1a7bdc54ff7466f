// What `patina filter` says of a path beside its heights.
#pragma once

#include "acquisition/filtering/filtered_scan.h"
#include "app/cli/output/report.h"

namespace patina::cli {

Json gapsJson(const FilteredScan& scan);
void reportSigma(const std::vector<PathSample>& path, Report& report);
// clock_offset, clock_skew and clock_deviation.
void reportClock(const ProbeClock& found, Report& report);

} // namespace patina::cli
