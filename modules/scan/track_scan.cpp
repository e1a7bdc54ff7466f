#include "scan/track_scan.h"

#include "core/error.h"

namespace patina {

TrackScanReport trackScan(const TrackScanOptions& options, Progress& progress,
                          const FrameListener& listener) {
  const std::unique_ptr<FrameSource> frames = openFrames(options.frames, options.rate);
  TrackScanReport report;
  try {
    static_cast<TrackedFrames&>(report) =
        trackFrames(*frames, options.camera, options.markers, options.finder, progress, listener);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.rig.string(), 0, error.what());
  }
  report.warnings = warningsOf(report, options.frames, options.rig);
  return report;
}

} // namespace patina
