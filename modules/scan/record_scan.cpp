#include "scan/record_scan.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {

std::unique_ptr<Recorder> startRecording(const RecordScanOptions& options) {
  auto frames = openFrames(options.frames, options.rate);
  auto probe = options.probe.empty() ? nullptr : openProbe(options.probe);
  return std::make_unique<Recorder>(std::move(frames), std::move(probe), options.setup);
}

RecordScanReport recordScan(const RecordScanOptions& options, Progress& progress) {
  const std::unique_ptr<Recorder> recorder = startRecording(options);
  RecordScanReport report;
  RecordingState& now = report.state;
  for (now = recorder->poll().state; now.running; now = recorder->poll().state) {
    const bool over = options.seconds && now.seconds >= *options.seconds;
    if (over || progress.cancelled()) recorder->stop();
    progress.report(options.seconds ? std::min(1., now.seconds / *options.seconds) : 0,
                    formatCount(now.frames) + " frames, " + formatCount(now.poses) + " poses, " +
                        formatCount(now.samples) + " samples");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (!now.error.empty() && now.frames == 0 && now.samples == 0) throw Error(now.error);
  std::vector<std::string>& warnings = report.warnings;
  if (!now.left_out.empty()) warnings.push_back(now.left_out);
  warnings.insert(warnings.end(), now.notes.begin(), now.notes.end());
  if (!now.tracks)
    warnings.push_back(options.setup.folder.string() + ": has frames only, for " +
                       (options.setup.camera.empty() ? "no camera.yml" : "no rig.json") +
                       " was given; after calibration, patina track finds the poses");
  if (now.frames == 0)
    warnings.push_back(options.setup.folder.string() + ": no frame came, so the scan is empty");
  if (!now.error.empty())
    warnings.push_back(now.error + "; what had reached the disk by then is kept");
  const bool silent = !options.probe.empty() && now.samples == 0;
  if (silent) warnings.push_back(options.probe + ": the probe sent nothing");
  report.complete = now.frames > 0 && !silent && now.error.empty();
  return report;
}

} // namespace patina
