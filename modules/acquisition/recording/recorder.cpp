#include "acquisition/recording/recorder.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/orientation.h"
#include "acquisition/recording/arrival_clock.h"
#include "acquisition/recording/row_file.h"
#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

constexpr auto kFlush = std::chrono::milliseconds(250);
constexpr double kDropout = 0.05; // [s]

std::string greyText(const GreyFrame& image) {
  std::string text =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  text.append(reinterpret_cast<const char*>(image.pixel.data()), image.pixel.size());
  return text;
}

void requireNoScan(const fs::path& folder) {
  for (const char* name : {"frames", "frames.csv", "probe.csv", "poses.tum"})
    if (fs::symlink_status(folder / name).type() != fs::file_type::not_found)
      throw FileError(folder.string(), 0, "holds a scan already: name another folder");
}

// Beside the frames; what is there already may be the same, as where a scan was prepared.
void writeBeside(const fs::path& path, const std::string& text) {
  if (!pathExists(path)) return writeFileAtomically(path, text);
  if (readFile(path) != text)
    throw FileError(path.string(), 0, "is another than the recording's: name another folder");
}

} // namespace

class Recorder::Work {
 public:
  Work(std::unique_ptr<FrameSource> frames, std::unique_ptr<ProbeSource> probe,
       const RecordingSetup& setup)
      : frames_(std::move(frames)), probe_(std::move(probe)), folder_(setup.folder),
        camera_(readCamera(setup.camera)), tracker_(camera_, readMarkers(setup.rig), setup.finder),
        begin_(SteadyClock::now()) {
    if (probe_ && probe_->isLive() != frames_->isLive())
      throw Error("frames and probe share no clock: both must be live, or both recorded");
    requireNoScan(folder_);
    const std::string camera_text = readFile(setup.camera), rig_text = readFile(setup.rig);
    fresh_.emplace(folder_, "frames/000000.pgm");
    makeFolder(folder_);
    writeBeside(folder_ / "camera.yml", camera_text);
    writeBeside(folder_ / "rig.json", rig_text);
    makeFolder(folder_ / "frames");
    frame_rows_.emplace(folder_ / "frames.csv", frameListHeader());
    pose_rows_.emplace(folder_ / "poses.tum", posesHeader());
    if (probe_) probe_rows_.emplace(folder_ / "probe.csv", probeHeader());
    state_.paused = setup.paused;
    probe_done_ = !probe_;
    const auto start = [&](void (Work::*work)()) {
      return std::thread([this, work] { guarded(work); });
    };
    threads_.push_back(start(&Work::readFrames));
    threads_.push_back(start(&Work::track));
    if (probe_) threads_.push_back(start(&Work::readProbe));
    threads_.push_back(start(&Work::keepWriting));
  }

  ~Work() {
    stop();
    if (state_.error.empty()) fresh_->keep();
  }

  void setPaused(bool paused) {
    const std::lock_guard lock(mutex_);
    state_.paused = paused;
  }

  void stop() {
    endSources();
    const std::lock_guard lock(joining_);
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  RecordingNews poll() {
    const std::lock_guard lock(mutex_);
    if (state_.running) state_.seconds = now();
    RecordingNews news = std::move(news_);
    news_ = {};
    news_.frame = news.frame;
    news.state = state_;
    return news;
  }

 private:
  struct Arrived {
    SourceFrame frame; // at the recording's time
    bool written;
  };

  double now() const { return std::chrono::duration<double>(SteadyClock::now() - begin_).count(); }

  void endSources() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      changed_.notify_all();
    }
    frames_->stop();
    if (probe_) probe_->stop();
  }

  void fail(const std::string& cause) {
    {
      const std::lock_guard lock(mutex_);
      if (state_.error.empty()) state_.error = cause;
    }
    endSources();
  }

  void guarded(void (Work::*work)()) {
    try {
      (this->*work)();
    } catch (const std::exception& error) {
      fail(error.what());
    }
    const std::lock_guard lock(mutex_);
    if (work == &Work::readFrames) frames_done_ = true;
    if (work == &Work::track) tracking_done_ = true;
    if (work == &Work::readProbe) probe_done_ = state_.probe_ended = true;
    changed_.notify_all();
  }

  void readFrames() {
    int number = 0;
    while (std::optional<SourceFrame> frame = frames_->next()) {
      if (frame->fault.empty()) takeCamera(*frame);
      if (frames_->isLive()) frame->t = frame_clock_.timeOf(frame->t, now());
      const bool write = !isPaused();
      if (write && frame->fault.empty())
        createFile(folder_ / "frames" / (frameStem(number) + ".pgm"), greyText(frame->image));
      std::unique_lock lock(mutex_);
      if (write) {
        if (number == 0) fresh_->keep();
        frame_rows_->add(std::to_string(number) + "," + formatNumber(frame->t) + "\n");
        ++number;
        ++state_.frames;
      }
      if (!frame->fault.empty()) {
        ++state_.unreadable;
        leaveOut({frame->t, frame->fault}, write);
        continue;
      }
      if (!frames_->isLive()) changed_.wait(lock, [&] { return stopping_ || !waiting_; });
      if (waiting_) {
        ++state_.skipped;
        leaveOut({waiting_->frame.t, "skipped, as the one before it was still looked at"},
                 waiting_->written);
      }
      waiting_ = Arrived{std::move(*frame), write};
      changed_.notify_all();
    }
    std::vector<std::string> notes = frames_->notes();
    const bool along = taken_ && shown_.width != camera_.width;
    if (const std::string line = turns_.line(along ? &camera_ : nullptr, kTurnedUnlike);
        !line.empty())
      notes.push_back(line);
    const std::lock_guard lock(mutex_);
    state_.notes = std::move(notes);
  }

  // The camera turns along with the first frame; one camera is that of all.
  void takeCamera(const SourceFrame& frame) {
    if (!std::exchange(taken_, true)) {
      shown_ = cameraOf(frame.image, camera_, frame.name);
      tracker_.setCamera(shown_); // before it has a frame
      if (shown_.width != camera_.width)
        writeFileAtomically(folder_ / "camera.yml", cameraText(shown_));
    }
    requireSize(frame.image, shown_, frame.name);
    turns_.add(frame.image, frame.name);
  }

  bool isPaused() {
    const std::lock_guard lock(mutex_);
    return state_.paused;
  }

  // Under the lock.
  void leaveOut(const NoPose& without, bool written) {
    if (written) pose_rows_->add(poseRow(without));
    news_.without.push_back(without);
  }

  void track() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return waiting_ || frames_done_; });
      if (!waiting_) return;
      Arrived arrived = std::move(*waiting_);
      waiting_.reset();
      changed_.notify_all();
      lock.unlock();
      auto seen = std::make_shared<RecordedFrame>();
      seen->t = arrived.frame.t;
      const SeenRig rig = tracker_.track(arrived.frame.image, seen->t);
      seen->name = std::move(arrived.frame.name);
      seen->image = std::move(arrived.frame.image);
      seen->markers = tracker_.markers();
      seen->verdict = rig.verdict;
      if (rig.verdict != RigVerdict::seen) seen->why = reasonOf(rig);
      if (rig.verdict == RigVerdict::seen) seen->pose = cameraPose(rig, seen->t);
      lock.lock();
      if (seen->pose) {
        if (arrived.written) {
          pose_rows_->add(poseRow(*seen->pose));
          ++state_.poses;
        }
        news_.poses.push_back(*seen->pose);
      } else {
        leaveOut({seen->t, seen->why}, arrived.written);
      }
      news_.frame = seen;
    }
  }

  void readProbe() {
    std::vector<ProbeSample> batch;
    std::optional<double> last;
    std::exception_ptr failure; // after samples that came before it
    while (!failure) {
      try {
        if (!probe_->read(batch)) break;
      } catch (...) {
        failure = std::current_exception();
      }
      const double arrival = now();
      const std::lock_guard lock(mutex_);
      for (ProbeSample& sample : batch) {
        if (probe_->isLive()) sample.t = probe_clock_.timeOf(sample.t, arrival);
        state_.dropouts += last && sample.t - *last > kDropout;
        last = sample.t;
        if (!state_.paused) {
          if (state_.samples == 0) fresh_->keep();
          probe_rows_->add(probeRow(sample));
          ++state_.samples;
        }
        news_.samples.push_back(sample);
      }
      batch.clear();
      state_.probe = probe_->health();
      if (state_.left_out.empty()) state_.left_out = probe_->leftOut();
    }
    if (failure) std::rethrow_exception(failure);
  }

  void keepWriting() {
    for (bool ended = false; !ended;) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kFlush, [&] { return hasEnded(); });
        ended = hasEnded();
      }
      // Nothing of a camera that has ended tells what the probe feels.
      if (framesEnded() && probe_ && probe_->isLive()) probe_->stop();
      flush(*frame_rows_);
      if (probe_) flush(*probe_rows_);
      flush(*pose_rows_);
      const std::lock_guard lock(mutex_);
      if (ended) {
        state_.seconds = now();
        state_.running = false;
      }
    }
  }

  // Under the lock.
  bool hasEnded() const { return tracking_done_ && frames_done_ && probe_done_; }
  bool framesEnded() {
    const std::lock_guard lock(mutex_);
    return frames_done_;
  }

  void flush(RowFile& rows) {
    std::string pending;
    {
      const std::lock_guard lock(mutex_);
      pending = rows.takePending();
    }
    try {
      rows.write(pending);
    } catch (const FileError& error) {
      fail(error.what());
    }
  }

  const std::unique_ptr<FrameSource> frames_;
  const std::unique_ptr<ProbeSource> probe_;
  const fs::path folder_;
  const Camera camera_; // as its file has it
  RigTracker tracker_;  // the tracking thread's
  // The frames' thread's.
  bool taken_ = false; // what follows
  Camera shown_;       // as the frames are shown
  TurnedFrames turns_;
  const SteadyClock::time_point begin_;
  ArrivalClock frame_clock_, probe_clock_; // each its thread's

  std::mutex mutex_; // for all below
  std::condition_variable changed_;
  std::optional<NewFolder> fresh_; // one that failed before anything came is taken back
  std::optional<RowFile> frame_rows_, pose_rows_, probe_rows_;
  std::optional<Arrived> waiting_;
  RecordingState state_;
  RecordingNews news_;
  bool stopping_ = false, frames_done_ = false, tracking_done_ = false, probe_done_ = false;

  std::mutex joining_;
  std::vector<std::thread> threads_;
};

Recorder::Recorder(std::unique_ptr<FrameSource> frames, std::unique_ptr<ProbeSource> probe,
                   const RecordingSetup& setup)
    : work_(std::make_unique<Work>(std::move(frames), std::move(probe), setup)) {}

Recorder::~Recorder() = default;

void Recorder::pause() {
  work_->setPaused(true);
}

void Recorder::resume() {
  work_->setPaused(false);
}

void Recorder::stop() {
  work_->stop();
}

RecordingNews Recorder::poll() {
  return work_->poll();
}

} // namespace patina
