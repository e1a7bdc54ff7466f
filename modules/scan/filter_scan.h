// A scan's poses and its probe's stream become the tip's path.
#pragma once

#include <vector>

#include "acquisition/filtering/filtered_scan.h"
#include "scan/scan_files.h"

namespace patina {

// What came of one scan: its poses and the probe's stream, on one clock.
struct ScanStreams {
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples; // forces are those that press
};

// How a scan is filtered unless somebody says otherwise: camera and accelerometers together where
// the rig names accelerometers and the probe was heard, else the camera's poses alone.
ScanFilter filterOf(const std::optional<Rig>& rig, bool has_probe);

// Throws Error where the probe never touches, and as filterScan() does.
FilteredScan touchedPath(const ScanStreams& streams, const std::optional<Rig>& rig,
                         Progress& progress);

} // namespace patina
