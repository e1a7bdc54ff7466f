// Settings of a recording and its state while it runs.
#pragma once

#include <filesystem>
#include <memory>

#include "acquisition/files/scan_tables.h"
#include "acquisition/sources/sources.h"
#include "acquisition/tracking/track_frames.h"

namespace patina {

struct RecordingSetup {
  std::filesystem::path folder; // is made; must not hold a scan
  // camera.yml and rig.json, whose copies stand in it. Each may be empty; then nothing is tracked.
  std::filesystem::path camera, rig;
  FinderOptions finder;
  bool paused = false; // from the beginning: shows what the sources see before it is written
};

// The newest frame that was tracked.
struct RecordedFrame {
  double t = 0; // [s], on the recording's clock
  std::string name;
  GreyFrame image;
  std::vector<SeenMarker> markers;
  RigVerdict verdict = RigVerdict::no_marker;
  std::string why;                // it has no pose; empty if it has one
  std::optional<CameraPose> pose; // set if the verdict is `seen`
};

struct RecordingState {
  bool running = true;
  bool paused = false;
  bool tracks = true; // false without a camera or a rig: there are no poses
  double seconds = 0; // since the beginning
  // Written, or on their way to the disk for a quarter of a second at most.
  std::size_t frames = 0, poses = 0, samples = 0;
  std::size_t skipped = 0;          // frames that there was no time to track; they are written
  std::size_t unreadable = 0;       // frames
  std::size_t dropouts = 0;         // gaps of the probe's stream above 50 ms
  bool probe_ended = false;         // it sends no more
  std::optional<ProbeHealth> probe; // state of a probe that sends packets
  std::string left_out;             // columns of the probe's table that are not used
  std::vector<std::string> notes;   // notes of the frame source after its end, one line each
  std::string error;                // why it ended, if that was not asked for; one line
};

// Data since the last poll, including data that arrived during a pause.
struct RecordingUpdate {
  RecordingState state;
  std::shared_ptr<const RecordedFrame>
      frame; // the newest, which may be the last time's; or nullptr
  std::vector<CameraPose> poses;
  std::vector<MissingPose> without;
  std::vector<ProbeSample> samples; // raw force readings, as on disk; see forceOf()
};

} // namespace patina
