// Frames of a camera become poses of the markers' rig: what `patina track`, `patina scan`, the desk
// Scan and the demo run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/tracking/track_frames.h"

namespace patina {

struct TrackScanOptions {
  std::string frames; // see openFrames()
  Camera camera;
  std::vector<RigMarker> markers;
  std::filesystem::path rig; // their file, as errors and warnings name it
  double rate = 0;           // [Hz], see openFrames()
  FinderOptions finder{};
};

struct TrackScanReport : TrackedFrames {
  std::vector<std::string> warnings; // see warningsOf()
};

// Throws FileError: as openFrames() and trackFrames() do, or where the rig names markers that there
// are not. The caller checks `progress` for a cancel.
TrackScanReport trackScan(const TrackScanOptions& options, Progress& progress,
                          const FrameListener& listener = {});

} // namespace patina
