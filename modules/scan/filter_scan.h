// Filters a scan's poses and probe samples into the tip's path.
#pragma once

#include <vector>

#include "acquisition/filtering/filtered_scan.h"
#include "scan/scan_files.h"

namespace patina {

// Poses and probe samples of one scan, on one clock.
struct ScanStreams {
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;   // pressing forces are positive
  std::vector<RateSample> rates = {}; // gyroscope; empty without one
};

// Default filter: camera and accelerometers together if the rig names accelerometers and there are
// probe samples, otherwise the camera's poses alone.
ScanFilter filterOf(const std::optional<Rig>& rig, bool has_probe);

// Throws as filterScan() does, and Error if the poses are not in metres. Without a rig the path is
// that of the poses' origin.
FilteredScan filterStreams(const ScanStreams& streams, const std::optional<Rig>& rig,
                           const ScanFilter& filter, Progress& progress);
// The same as filterOf() has it. Throws Error where the probe never touches.
FilteredScan contactPath(const ScanStreams& streams, const std::optional<Rig>& rig,
                         Progress& progress);

} // namespace patina
