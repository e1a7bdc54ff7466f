#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <future>
#include <thread>
#include <utility>

#include "acquisition/files/frame_files.h"
#include "acquisition/loaded/video.h"
#include "acquisition/sources/pace.h"
#include "acquisition/sources/sources.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"
#include "core/numbers.h"

namespace patina {
namespace {

// Returns OpenCV's readers of videos and cameras, loaded on first use. Throws Error that names the
// missing file and the places searched.
const VideoLibrary& videoLibrary() {
  static std::string video_cause;
  static void* const video_symbol = [] {
    requireRoomToLoad("the library of video");
    // Read while loading: silences FFmpeg's console output, whose content is in our errors, and
    // shortens the timeout of a silent camera.
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    ::setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", "1", 0);
    return loadedSymbol("patina_video.so", kVideoLibrarySymbol, video_cause);
  }();
  if (!video_symbol)
    throw Error("videos and cameras need Patina's library of video, which cannot be loaded: " +
                video_cause);
  return *reinterpret_cast<VideoLibraryFunction*>(video_symbol)();
}

constexpr double kHighestRate = 1000; // [Hz]; higher rates are time bases of containers
constexpr double kLongest = 1e7;      // longest video [s]

// Frames of a folder, and a line about its other files.
struct FolderList {
  std::vector<Frame> frames;
  bool timed;
  std::string left_out;
  std::vector<std::string> notes() const {
    return left_out.empty() ? std::vector<std::string>() : std::vector{left_out};
  }
};

SourceFrame readFrame(const Frame& frame) {
  SourceFrame read{frame.t, frame.file.string(), {}, {}};
  try {
    read.image = readGrey(frame.file);
  } catch (const FileError& error) {
    read.fault = error.what();
  }
  return read;
}

// Reads one frame ahead in its own thread.
class FolderFrames : public FrameSource {
 public:
  FolderFrames(FolderList list) : list_(std::move(list)) {}
  std::optional<SourceFrame> next() override {
    if (stopped_ || at_ >= list_.frames.size()) return std::nullopt;
    SourceFrame frame = ahead_.valid() ? ahead_.get() : readFrame(list_.frames[at_]);
    if ((at_ += step_) < list_.frames.size())
      ahead_ = std::async(std::launch::async, readFrame, std::cref(list_.frames[at_]));
    return frame;
  }
  std::optional<std::size_t> count() const override { return list_.frames.size(); }
  bool isLive() const override { return false; }
  void stop() noexcept override { stopped_ = true; }
  bool keepEach(std::size_t step) override {
    step_ = step;
    return true;
  }
  bool arePictures() const override { return !list_.timed; }
  std::vector<std::string> notes() const override { return list_.notes(); }

 private:
  FolderList list_;
  std::size_t at_ = 0, step_ = 1;
  std::atomic<bool> stopped_{false};
  std::future<SourceFrame> ahead_; // last member: its destructor waits for the thread
};

class ReplayedFrames : public FrameSource {
 public:
  ReplayedFrames(FolderList list, double start)
      : list_(std::move(list)), start_(start), ahead_(readFrame(list_.frames[0])) {}
  std::optional<SourceFrame> next() override {
    if (at_ == list_.frames.size()) return std::nullopt;
    if (!ahead_) ahead_ = readFrame(list_.frames[at_]);
    if (!pace_.waitUntil(ahead_->t - start_)) return std::nullopt;
    ++at_;
    return std::exchange(ahead_, std::nullopt);
  }
  std::optional<std::size_t> count() const override { return list_.frames.size(); }
  bool isLive() const override { return true; }
  void stop() noexcept override { pace_.stop(); }
  std::vector<std::string> notes() const override { return list_.notes(); }

 private:
  FolderList list_;
  double start_;
  std::size_t at_ = 0;
  // Read before it is due, because reading and the first loading of a library take time.
  std::optional<SourceFrame> ahead_;
  StoppableTimer pace_;
};

class VideoFrames : public FrameSource {
 public:
  VideoFrames(const std::string& path, double rate) : path_(path), told_rate_(rate) {
    const std::string cause = videoLibrary().openFile(path, reader_);
    if (!cause.empty()) throw FileError(path, 0, cause);
  }
  std::optional<SourceFrame> next() override {
    if (stopped_ || ended_) return std::nullopt;
    SourceFrame frame{0, path_ + " frame " + std::to_string(at_), {}, {}};
    double stamp = NAN;
    frame.fault = reader_->next(frame.image, stamp, ended_);
    if (ended_) {
      if (isWhole()) return std::nullopt;
      frame.fault = path_ + ": ends after frame " + std::to_string(at_) + " of " +
                    std::to_string(reader_->count) + ": damaged, or not whole";
    }
    frame.t = timeOf(stamp, frame);
    if (!frame.fault.empty()) frame.image = {};
    ++at_;
    return frame;
  }
  std::optional<std::size_t> count() const override {
    if (reader_->count == 0 || reader_->rate > kHighestRate) return std::nullopt;
    return static_cast<std::size_t>(reader_->count);
  }
  bool isLive() const override { return false; }
  void stop() noexcept override { stopped_ = true; }
  std::vector<std::string> notes() const override {
    std::vector<std::string> lines;
    if (untimed_ && !(told_rate_ > 0))
      lines.push_back(path_ + ": has no frame times, so " + formatNumber(reader_->rate) +
                      " frames per second are assumed; --rate sets another number");
    if (reader_->lost > 0 && !untimed_ && !(told_rate_ > 0))
      lines.push_back(path_ + ": " + formatCount(index(reader_->lost)) +
                      " of its pictures cannot be decoded; it is unknown which, so that frames may "
                      "have the time of an earlier one");
    return lines;
  }

 private:
  // Returns the time of a frame at an even rate, if one was given or the container has no times.
  double evenTime() const {
    const double said = reader_->rate <= kHighestRate ? reader_->rate : 0;
    const double rate = told_rate_ > 0 ? told_rate_ : said;
    if (at_ > 0 && !(rate > 0))
      throw FileError(path_, 0, "has neither frame times nor a frame rate: set --rate");
    return at_ > 0 ? static_cast<double>(at_) / rate : 0;
  }

  double timeOf(double stamp, SourceFrame& frame) {
    const bool readable = std::abs(stamp) < kLongest, later = readable && stamp > stamp_;
    // Containers without times report none, or the same for all frames.
    if (!ended_ && ((at_ == 0 && !readable) || (at_ == 1 && !later))) untimed_ = true;
    if (at_ > 0 && later) gap_ = std::max(gap_, stamp - stamp_);
    if (later) stamp_ = stamp;
    if (told_rate_ > 0 || untimed_) return evenTime();
    if (ended_) return stamp_ + gap_;
    if (at_ > 0 && !later) {
      if (frame.fault.empty())
        frame.fault = frame.name + ": its time in the container is not after that of the frame "
                                   "before it";
      stamp_ += 1e-6; // keeps frame times distinct
    }
    return stamp_;
  }

  // Returns true if the file is complete. Containers round their frame count or only store the
  // duration, and cut frames may still be in the file. Other missing frames are damage.
  bool isWhole() const {
    const auto said = static_cast<std::size_t>(reader_->count);
    if (at_ + 2 + said / 100 >= said) return true;
    const double seconds = reader_->rate > 0 ? reader_->count / reader_->rate : 0;
    if (!untimed_ && stamp_ + 2 * gap_ >= 0.99 * seconds) return true;
    return reader_->held >= reader_->count;
  }

  std::string path_;
  std::unique_ptr<VideoReader> reader_;
  double told_rate_;           // [Hz]; 0: not given
  double stamp_ = 0, gap_ = 0; // time of the last frame and longest time step
  bool untimed_ = false;
  std::size_t at_ = 0;
  bool ended_ = false;
  std::atomic<bool> stopped_{false};
};

// Its own thread waits for the camera, so that callers can be stopped and stamps are prompt.
class CameraFrames : public FrameSource {
 public:
  CameraFrames(int number) : name_("camera:" + std::to_string(number)) {
    const std::string cause = videoLibrary().openCamera(number, reader_);
    if (!cause.empty()) throw DeviceError(name_ + ": " + cause);
    thread_ = std::thread([this] { grab(); });
  }
  ~CameraFrames() override {
    stop();
    thread_.join();
  }
  std::optional<SourceFrame> next() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || !frames_.empty() || !cause_.empty(); });
    if (stopped_) return std::nullopt;
    if (frames_.empty()) throw DeviceError(name_ + ": " + cause_);
    SourceFrame frame = std::move(frames_.front());
    frames_.pop_front();
    changed_.notify_all();
    return frame;
  }
  std::optional<std::size_t> count() const override { return std::nullopt; }
  bool isLive() const override { return true; }
  void stop() noexcept override {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

 private:
  static constexpr std::size_t kMost = 32; // longest queue of frames

  void grab() {
    for (std::size_t number = 0;; ++number) {
      SourceFrame frame;
      bool ended = false;
      const std::string cause = reader_->next(frame.image, frame.t, ended);
      frame.name = std::to_string(number);
      std::unique_lock lock(mutex_);
      if (ended || !cause.empty()) {
        cause_ = ended ? "sends no more frames; is it still plugged in?" : cause;
        changed_.notify_all();
        return;
      }
      changed_.wait(lock, [&] { return stopped_ || frames_.size() < kMost; });
      if (stopped_) return;
      frames_.push_back(std::move(frame));
      changed_.notify_all();
    }
  }

  std::string name_;
  std::unique_ptr<VideoReader> reader_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SourceFrame> frames_;
  std::string cause_;
  bool stopped_ = false;
  std::thread thread_;
};

int cameraNumber(const std::string& word) {
  const auto number = parseNumber(word);
  if (!number || !(*number >= 0 && *number < 1000) || *number != static_cast<int>(*number))
    throw Error("camera:" + word + ": a camera has a number, as in camera:0");
  return static_cast<int>(*number);
}

// Throws if all frames are missing; other errors appear when a frame is read.
FolderList framesToRead(const std::filesystem::path& folder, double rate) {
  FolderList list{{}, std::filesystem::exists(folder / "frames.csv"), {}};
  list.frames = framesOf(folder, rate, &list.left_out);
  const auto isMissing = [](const Frame& frame) {
    std::error_code code;
    return std::filesystem::status(frame.file, code).type() ==
           std::filesystem::file_type::not_found;
  };
  if (std::all_of(list.frames.begin(), list.frames.end(), isMissing))
    throw FileError((folder / "frames").string(), 0,
                    "holds none of the " + std::to_string(list.frames.size()) +
                        " pictures that frames.csv lists");
  return list;
}

} // namespace

double replayStart(const std::string& folder, double first_frame) {
  const std::filesystem::path probe = std::filesystem::path(folder) / "probe.csv";
  if (!std::filesystem::exists(probe)) return first_frame;
  CsvReader reader(probe, {{"t [s]"}});
  std::vector<double> row;
  return reader.next(row) ? std::min(row[0], first_frame) : first_frame;
}

std::optional<std::filesystem::path> scanFolderOf(const std::string& frames) {
  if (frames.starts_with("replay:")) return frames.substr(7);
  if (std::filesystem::is_directory(frames)) return frames;
  return std::nullopt;
}

std::unique_ptr<FrameSource> openFrames(const std::string& frames, double rate) {
  if (frames.starts_with("camera:"))
    return std::make_unique<CameraFrames>(cameraNumber(frames.substr(7)));
  if (frames.starts_with("replay:")) {
    const std::string folder = frames.substr(7);
    FolderList list = framesToRead(folder, rate);
    const double start = replayStart(folder, list.frames[0].t);
    return std::make_unique<ReplayedFrames>(std::move(list), start);
  }
  if (!std::filesystem::exists(frames)) throw FileError(frames, 0, "does not exist");
  if (std::filesystem::is_directory(frames))
    return std::make_unique<FolderFrames>(framesToRead(frames, rate));
  return std::make_unique<VideoFrames>(frames, rate);
}

} // namespace patina
