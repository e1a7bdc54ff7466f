#include "acquisition/recording/recorder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/recording/min_delay_clock.h"
#include "acquisition/values/orientation.h"
#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

namespace patina {

// A table of a scan folder that grows by complete rows while it is recorded. One thread, or several
// under one lock, may add rows while another one writes earlier rows.
class RowFile {
 public:
  static constexpr std::size_t kLongestRow = 512; // [bytes]

  // Creates the file. Throws FileError.
  RowFile(const std::filesystem::path& path, const std::string& header);
  // Appends a row with its line's end. A row longer than kLongestRow is cut.
  void add(std::string row);

  std::string takePending() {
    std::string pending;
    pending.swap(pending_);
    return pending;
  }
  void write(const std::string& pending); // returns when the data are on disk; throws FileError

 private:
  std::optional<AppendFile> file_;
  std::size_t size_ = 0; // size including pending rows
  std::string pending_;
};

namespace {

constexpr std::size_t kPage = 4096;

} // namespace

RowFile::RowFile(const std::filesystem::path& path, const std::string& header)
    : size_(header.size()) {
  createFile(path, header);
  file_.emplace(path);
}

void RowFile::add(std::string row) {
  if (row.size() > kLongestRow) row.replace(kLongestRow - 1, std::string::npos, 1, '\n');
  // A program killed while it writes stops at a page boundary. Rows are padded with blanks before
  // the line's end so that none crosses it and none is left incomplete.
  const std::size_t left = kPage - (size_ + row.size()) % kPage;
  if (left < kLongestRow) row.insert(row.size() - 1, left, ' ');
  size_ += row.size();
  pending_ += row;
}

void RowFile::write(const std::string& pending) {
  if (!pending.empty()) file_->append(pending);
}

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

// Returns true if the file is missing, or holds one of these headers or nothing, and nobody is
// writing it.
bool hasNoRow(const fs::path& table, const std::vector<std::string>& headers) {
  if (!pathExists(table)) return true;
  try {
    if (fs::file_size(table) > kPage) return false;
    const std::string text = AppendFile(table).content();
    return text.empty() || std::find(headers.begin(), headers.end(), text) != headers.end();
  } catch (const std::exception&) {
    return false;
  }
}

constexpr std::array kScanFiles = {"frames", "frames.csv", "probe.csv", "poses.tum"};

// Returns the pictures of a folder that has nothing but a recording's first ones.
std::optional<std::vector<fs::path>> firstPictures(const fs::path& frames) {
  constexpr std::size_t kMostPictures = 60; // those of a quarter of a second at 240 Hz
  std::vector<fs::path> pictures;
  if (!pathExists(frames)) return pictures;
  std::error_code failed;
  for (fs::directory_iterator entry(frames, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const fs::path name = entry->path().filename();
    const std::string stem = name.stem().string();
    const bool own = stem.size() == 6 && name.extension() == ".pgm" &&
                     stem.find_first_not_of("0123456789") == std::string::npos &&
                     entry->symlink_status(failed).type() == fs::file_type::regular;
    if (!own || pictures.size() == kMostPictures) return std::nullopt;
    pictures.push_back(entry->path());
  }
  return failed ? std::nullopt : std::optional(pictures);
}

// Returns what a recording leaves that was killed before its first rows were on disk, none in a
// folder without any: tables with a header alone, and pictures whose times are lost. Throws
// FileError if the folder holds anything else of a scan.
std::vector<fs::path> leftoversIn(const fs::path& folder) {
  std::vector<fs::path> found;
  bool linked = false;
  for (const char* name : kScanFiles) {
    const fs::file_type type = fs::symlink_status(folder / name).type();
    linked = linked || type == fs::file_type::symlink;
    if (type != fs::file_type::not_found) found.push_back(folder / name);
  }
  if (found.empty()) return found;
  const bool bare = !linked && hasNoRow(folder / "frames.csv", {frameListHeader()}) &&
                    hasNoRow(folder / "probe.csv", {probeHeader(false), probeHeader(true)}) &&
                    hasNoRow(folder / "poses.tum", {posesHeader()});
  const auto pictures = bare ? firstPictures(folder / "frames") : std::nullopt;
  if (!pictures || (!pictures->empty() && !pathExists(folder / "frames.csv")))
    throw FileError(folder.string(), 0, "holds a scan already: name another folder");
  found.insert(found.begin(), pictures->begin(), pictures->end());
  return found;
}

// Writes a file next to the frames. An equal file may exist, as in a prepared folder.
void writeBeside(const fs::path& path, const std::string& text) {
  if (!pathExists(path))
    writeFileAtomically(path, text);
  else if (readFile(path) != text)
    throw FileError(path.string(), 0, "is another than the recording's: name another folder");
}

} // namespace

class Recorder::Work {
 public:
  Work(std::unique_ptr<FrameSource> frames, std::unique_ptr<ProbeSource> probe,
       const RecordingSetup& setup)
      : frames_(std::move(frames)), probe_(std::move(probe)), folder_(setup.folder),
        begin_(SteadyClock::now()) {
    if (!setup.camera.empty()) camera_ = readCamera(setup.camera);
    std::vector<RigMarker> markers;
    if (!setup.rig.empty()) markers = readMarkers(setup.rig);
    if (camera_ && !markers.empty()) tracker_.emplace(*camera_, markers, setup.finder);
    if (probe_ && probe_->isLive() != frames_->isLive())
      throw Error("frames and probe share no clock: both must be live, or both recorded");
    const std::vector<fs::path> leftovers = leftoversIn(folder_);
    const auto textOf = [](const fs::path& file) { return file.empty() ? "" : readFile(file); };
    const std::string camera_text = textOf(setup.camera), rig_text = textOf(setup.rig);
    fresh_.emplace(folder_, "frames/000000.pgm");
    makeFolder(folder_);
    if (!camera_text.empty()) writeBeside(folder_ / "camera.yml", camera_text);
    if (!rig_text.empty()) writeBeside(folder_ / "rig.json", rig_text);
    for (const fs::path& leftover : leftovers) {
      lost_ += leftover.parent_path() != folder_; // a picture
      fs::remove(leftover);
    }
    makeFolder(folder_ / "frames");
    frame_rows_ = std::make_unique<RowFile>(folder_ / "frames.csv", frameListHeader());
    if (tracker_) pose_rows_ = std::make_unique<RowFile>(folder_ / "poses.tum", posesHeader());
    state_.tracks = tracker_.has_value();
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

  RecordingUpdate poll() {
    const std::lock_guard lock(mutex_);
    if (state_.running) state_.seconds = now();
    RecordingUpdate news = std::move(news_);
    news_ = {};
    news_.frame = news.frame;
    news.state = state_;
    return news;
  }

 private:
  struct Arrived {
    SourceFrame frame; // in the recording's time
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
      if (waiting_ && tracker_) {
        ++state_.skipped;
        leaveOut({waiting_->frame.t, "skipped, as the one before it was still looked at"},
                 waiting_->written);
      }
      waiting_ = Arrived{std::move(*frame), write};
      changed_.notify_all();
    }
    std::vector<std::string> notes = frames_->notes();
    const bool along = taken_ && camera_ && shown_.width != camera_->width;
    if (const std::string line = turns_.line(along ? &*camera_ : nullptr, kTurnedUnlike);
        !line.empty())
      notes.push_back(line);
    if (lost_ > 0)
      notes.push_back("replaced a recording that was killed before its first row: " +
                      std::to_string(lost_) + " pictures without a time");
    const std::lock_guard lock(mutex_);
    state_.notes = std::move(notes);
  }

  // The first frame decides how the calibration is turned; all later frames must have its size.
  void takeCamera(const SourceFrame& frame) {
    if (!std::exchange(taken_, true)) {
      shown_.width = frame.image.width;
      shown_.height = frame.image.height;
      if (camera_) shown_ = cameraOf(frame.image, *camera_, frame.name);
      if (tracker_) tracker_->setCamera(shown_); // before its first frame
      if (camera_ && shown_.width != camera_->width)
        writeFileAtomically(folder_ / "camera.yml", cameraText(shown_));
    }
    requireSize(frame.image, shown_, frame.name);
    turns_.add(frame.image, frame.name);
  }

  bool isPaused() {
    const std::lock_guard lock(mutex_);
    return state_.paused;
  }

  // The caller holds the lock.
  void leaveOut(const MissingPose& without, bool written) {
    if (written && pose_rows_) pose_rows_->add(poseRow(without));
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
      if (tracker_) {
        const SeenRig rig = tracker_->track(arrived.frame.image, seen->t);
        seen->markers = tracker_->markers();
        seen->verdict = rig.verdict;
        if (rig.verdict != RigVerdict::seen) seen->why = reasonOf(rig);
        if (rig.verdict == RigVerdict::seen) seen->pose = cameraPose(rig, seen->t);
      } else {
        seen->why = "not looked at, without a camera.yml and a rig.json";
      }
      seen->name = std::move(arrived.frame.name);
      seen->image = std::move(arrived.frame.image);
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
    std::vector<RateSample> rates; // one for each sample, or none
    std::optional<double> last;
    std::exception_ptr failure; // thrown after the samples that came before it
    while (!failure) {
      try {
        if (!probe_->read(batch, &rates)) break;
      } catch (...) {
        failure = std::current_exception();
      }
      const double arrival = now();
      if (!batch.empty()) createProbeRows(!rates.empty());
      const std::lock_guard lock(mutex_);
      for (std::size_t i = 0; i < batch.size(); ++i) {
        ProbeSample& sample = batch[i];
        if (probe_->isLive()) sample.t = probe_clock_.timeOf(sample.t, arrival);
        state_.dropouts += last && sample.t - *last > kDropout;
        last = sample.t;
        if (!state_.paused) {
          if (state_.samples == 0) fresh_->keep();
          probe_rows_->add(probeRow(sample, rates.empty() ? nullptr : &rates[i]));
          ++state_.samples;
        }
        news_.samples.push_back(sample);
      }
      batch.clear();
      rates.clear();
      state_.probe = probe_->health();
      if (state_.left_out.empty()) state_.left_out = probe_->leftOut();
    }
    createProbeRows(false);
    if (failure) std::rethrow_exception(failure);
  }

  // Creates probe.csv once. The first samples show whether there is a gyroscope.
  void createProbeRows(bool gyroscope) {
    if (probe_rows_) return; // only this thread creates it
    auto rows = std::make_unique<RowFile>(folder_ / "probe.csv", probeHeader(gyroscope));
    const std::lock_guard lock(mutex_);
    probe_rows_ = std::move(rows);
  }

  void keepWriting() {
    for (bool ended = false; !ended;) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kFlush, [&] { return hasEnded(); });
        ended = hasEnded();
      }
      // Once the camera has ended, further samples of the probe cannot be used.
      if (framesEnded() && probe_ && probe_->isLive()) probe_->stop();
      flush(frame_rows_);
      flush(probe_rows_);
      flush(pose_rows_);
      const std::lock_guard lock(mutex_);
      if (ended) {
        state_.seconds = now();
        state_.running = false;
      }
    }
  }

  // The caller holds the lock.
  bool hasEnded() const { return tracking_done_ && frames_done_ && probe_done_; }
  bool framesEnded() {
    const std::lock_guard lock(mutex_);
    return frames_done_;
  }

  void flush(const std::unique_ptr<RowFile>& rows) {
    std::string pending;
    {
      const std::lock_guard lock(mutex_);
      if (!rows) return;
      pending = rows->takePending();
    }
    try {
      rows->write(pending);
    } catch (const FileError& error) {
      fail(error.what());
    }
  }

  const std::unique_ptr<FrameSource> frames_;
  const std::unique_ptr<ProbeSource> probe_;
  const fs::path folder_;
  std::optional<Camera> camera_;      // camera of the file
  std::optional<RigTracker> tracker_; // used by the tracking thread; absent without camera or rig
  // Used by the frame thread.
  bool taken_ = false; // true once the members below are set
  Camera shown_;       // camera of the shown frames
  TurnedFrames turns_;
  const SteadyClock::time_point begin_;
  MinDelayClock frame_clock_, probe_clock_; // each used by its own thread

  std::size_t lost_ = 0; // pictures of a recording that never began
  std::mutex mutex_;     // guards all members below
  std::condition_variable changed_;
  std::optional<NewFolder> fresh_; // deletes the new folder if no data follow
  std::unique_ptr<RowFile> frame_rows_, pose_rows_, probe_rows_;
  std::optional<Arrived> waiting_;
  RecordingState state_;
  RecordingUpdate news_;
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

RecordingUpdate Recorder::poll() {
  return work_->poll();
}

} // namespace patina
