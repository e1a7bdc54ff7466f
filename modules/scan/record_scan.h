// A camera and a probe become a scan folder while they run: what `patina record` and the card
// Record run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/recording/recorder.h"

namespace patina {

struct RecordScanOptions {
  std::string frames;              // see openFrames()
  std::string probe;               // see openProbe(); empty: none
  double rate = 0;                 // [Hz], see openFrames()
  std::optional<double> seconds{}; // absent: until the frames end, or it is cancelled
  RecordingSetup setup{};
};

struct RecordScanReport {
  RecordingState state; // at the end
  std::vector<std::string> warnings;
  bool complete = false; // frames came, the probe sent something, and nothing failed
};

// Opens the sources and begins. Throws as these and Recorder() do; then nothing was made.
std::unique_ptr<Recorder> startRecording(const RecordScanOptions& options);

// Records until the sources end or `progress` is cancelled, which is no error. Throws also if a
// source failed before any data arrived.
RecordScanReport recordScan(const RecordScanOptions& options, Progress& progress);

} // namespace patina
