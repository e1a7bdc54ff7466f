// A scan folder made while camera and probe run, and seen meanwhile.
#pragma once

#include <filesystem>
#include <memory>

#include "acquisition/files/scan_files.h"
#include "acquisition/sources/sources.h"
#include "acquisition/tracking/track_frames.h"

namespace patina {

struct RecordingSetup {
  std::filesystem::path folder;      // is made; must not hold a scan
  std::filesystem::path camera, rig; // camera.yml and rig.json, whose copies stand in it
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
  std::optional<CameraPose> pose; // where the verdict is `seen`
};

struct RecordingState {
  bool running = true;
  bool paused = false;
  double seconds = 0; // since the beginning
  // Written, or on their way to the disk for a quarter of a second at most.
  std::size_t frames = 0, poses = 0, samples = 0;
  std::size_t skipped = 0;          // frames that there was no time to track; they are written
  std::size_t unreadable = 0;       // frames
  std::size_t dropouts = 0;         // where the probe's stream lacks more than 50 ms
  bool probe_ended = false;         // it sends no more
  std::optional<ProbeHealth> probe; // of one that sends packets
  std::string left_out;             // names columns of the probe's table that nobody reads
  std::vector<std::string> notes;   // of the frames' source, a line each, once it has ended
  std::string error;                // why it ended, if that was not asked for; one line
};

// What has come since the last time. What came while it was paused is in it too.
struct RecordingNews {
  RecordingState state;
  std::shared_ptr<const RecordedFrame>
      frame; // the newest, which may be the last time's; or nullptr
  std::vector<CameraPose> poses;
  std::vector<NoPose> without;
  std::vector<ProbeSample> samples; // as on disk: forces as shown, see forceOf()
};

// Threads of its own read the sources, track and write. No frame and no sample is left out on disk;
// frames that arrive while one is being tracked are skipped by the tracker, but for the newest, and
// `patina track` finds their poses later. A source that is not live waits for the tracker.
//
// Times on disk begin at 0 and are those of this machine's steady clock. A live source's own clock
// runs on more evenly than its data arrive: a time on disk is the source's, moved by the least
// delay with which anything has arrived so far (ArrivalClock). Sources that are not live keep their
// times, and then both must be files. What is left of an offset finds filter's fitClock().
//
// Frames that are turned (orientation.h) are written as they are shown, and camera.yml with them.
//
// Pictures are frames/NNNNNN.pgm; rows of frames.csv, probe.csv and poses.tum follow them to the
// disk every quarter of a second. So a program that is killed loses at most that, and each file
// holds whole rows.
class Recorder {
 public:
  // `probe` may be nullptr. Throws FileError, Error (families, sources that share no clock); then
  // nothing was made.
  Recorder(std::unique_ptr<FrameSource> frames, std::unique_ptr<ProbeSource> probe,
           const RecordingSetup& setup);
  ~Recorder(); // stops
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // All from any thread.
  void pause();
  void resume(); // numbers go on, time has a gap
  void stop();   // returns when everything is on disk
  RecordingNews poll();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

} // namespace patina
