// Records a scan folder from camera and probe, and reports the data while it runs.
#pragma once

#include "acquisition/recording/recording_state.h"

namespace patina {

// Threads of its own read the sources, track and write. No frame and no sample is left out on disk;
// frames that arrive while one is being tracked are skipped by the tracker, but for the newest, and
// `patina track` finds their poses later. A source that is not live waits for the tracker.
//
// Times on disk begin at 0 and use the steady clock of this machine. A live source's stamps have
// less jitter than the arrival of its data: its times are stamps plus the smallest delay so far
// (MinDelayClock). Sources that are not live keep their times, and then both must be files. The
// filter's fitClock() estimates the remaining offset.
//
// Turned frames (orientation.h) are written as they are shown, with a camera.yml that fits.
//
// Pictures are frames/NNNNNN.pgm; rows of frames.csv, probe.csv and poses.tum are flushed to disk
// every quarter of a second. A killed program loses at most that, and its files hold complete rows.
class Recorder {
 public:
  // `probe` may be nullptr. Throws FileError, Error (families, sources without a common clock);
  // then nothing is created.
  Recorder(std::unique_ptr<FrameSource> frames, std::unique_ptr<ProbeSource> probe,
           const RecordingSetup& setup);
  ~Recorder(); // stops the recording
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // May be called from any thread.
  void pause();
  void resume(); // continues the numbers; time has a gap
  void stop();   // returns when all data are on disk
  RecordingUpdate poll();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

} // namespace patina
