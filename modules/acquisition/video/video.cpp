#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "acquisition/loaded/video.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace patina {
namespace {

// Presentation times of a video file's pictures from its container. OpenCV reports decoding times,
// which differ if pictures are stored out of order, and none for the last pictures.
class PictureTimes {
 public:
  // A file that cannot be opened has no times.
  explicit PictureTimes(const std::string& path);
  ~PictureTimes();
  PictureTimes(const PictureTimes&) = delete;
  PictureTimes& operator=(const PictureTimes&) = delete;

  // Returns the time of the next shown picture, relative to the first one [s]; NaN: unknown.
  double next();
  // Number of pictures in the file, shown or not, and number of shown pictures that next() has not
  // returned. Both read the rest of the file.
  int held();
  int left();

 private:
  class File;
  std::unique_ptr<File> file_;
};

constexpr std::size_t kWaiting = 32; // more than codecs reorder

// Reads packets without decoding them; each contains a picture.
class PictureTimes::File {
 public:
  explicit File(const std::string& path) {
    if (avformat_open_input(&input_, ("file:" + path).c_str(), nullptr, nullptr) < 0 ||
        avformat_find_stream_info(input_, nullptr) < 0)
      return;
    for (unsigned i = 0; i < input_->nb_streams; ++i) {
      AVStream* stream = input_->streams[i];
      if (stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO && !stream_)
        stream_ = stream;
      else
        stream->discard = AVDISCARD_ALL;
    }
    packet_ = av_packet_alloc();
    // The reader invents times, or decoding times, for files of pictures only.
    const std::string_view format = input_->iformat->name;
    timed_ = stream_ && packet_ && !(input_->iformat->flags & AVFMT_NOTIMESTAMPS) &&
             !format.ends_with("_pipe");
    is_container_ = !(input_->iformat->flags & AVFMT_GENERIC_INDEX);
  }
  ~File() {
    av_packet_free(&packet_);
    avformat_close_input(&input_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  double next() {
    while (waiting_.size() < kWaiting && readPacket()) {
    }
    if (!timed_ || waiting_.empty()) return NAN;
    const std::int64_t stamp = waiting_.top();
    waiting_.pop();
    if (!first_) first_ = stamp;
    return static_cast<double>(stamp - *first_) * av_q2d(stream_->time_base);
  }
  int held() {
    while (readPacket()) {
    }
    return held_;
  }
  int left() {
    (void)held();
    return static_cast<int>(waiting_.size());
  }

 private:
  // Returns false at the end.
  bool readPacket() {
    if (!stream_ || !packet_) return false;
    for (bool mine = false; !mine; av_packet_unref(packet_)) {
      if (av_read_frame(input_, packet_) < 0) return false;
      mine = packet_->stream_index == stream_->index;
      if (!mine) continue;
      ++held_;
      const bool shown = packet_->pts != AV_NOPTS_VALUE || !is_container_;
      const std::int64_t stamp = shown ? packet_->pts : packet_->dts;
      // No picture is shown before the first key frame.
      if (!key_ && packet_->flags & AV_PKT_FLAG_KEY) key_ = stamp;
      mine = key_ && !(packet_->flags & AV_PKT_FLAG_DISCARD) && stamp >= *key_;
      if (!mine) continue;
      if (stamp == AV_NOPTS_VALUE) timed_ = false;
      waiting_.push(stamp);
    }
    return true;
  }

  AVFormatContext* input_ = nullptr;
  AVStream* stream_ = nullptr;
  AVPacket* packet_ = nullptr;
  bool timed_ = false, is_container_ = false;
  int held_ = 0;
  std::optional<std::int64_t> key_, first_;
  std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>> waiting_;
};

PictureTimes::PictureTimes(const std::string& path) : file_(std::make_unique<File>(path)) {}

PictureTimes::~PictureTimes() = default;

double PictureTimes::next() {
  return file_->next();
}

int PictureTimes::held() {
  return file_->held();
}

int PictureTimes::left() {
  return file_->left();
}

// No exception, not even std::bad_alloc, may leave the library.
template <typename Work> std::string guarded(const Work& work) {
  try {
    return work();
  } catch (const cv::Exception& error) {
    return "OpenCV: " + error.err;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "OpenCV failed";
  }
}

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class CaptureReader : public VideoReader {
 public:
  // `times` of a file; nullptr for a camera.
  CaptureReader(cv::VideoCapture capture, std::unique_ptr<PictureTimes> times)
      : capture_(std::move(capture)), times_(std::move(times)) {
    const double said = capture_.get(cv::CAP_PROP_FPS),
                 frames = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (std::isfinite(said) && said > 0) rate = said;
    if (times_ && frames > 0 && frames < 1e9) count = static_cast<int>(frames);
    // OpenCV rotates pictures as the container demands, and reports the clockwise angle in degrees.
    if (times_ && capture_.get(cv::CAP_PROP_ORIENTATION_AUTO) != 0) {
      const double degrees = capture_.get(cv::CAP_PROP_ORIENTATION_META);
      orientation_ = degrees == 90 ? 6 : degrees == 180 ? 3 : degrees == 270 ? 8 : 1;
    }
  }

  std::string next(GreyFrame& image, double& t, bool& ended) override {
    return guarded([&]() -> std::string {
      ended = !capture_.read(picture_);
      if (ended && times_) {
        held = times_->held();
        lost = times_->left();
      }
      if (ended) return "";
      t = times_ ? times_->next() : cameraTime();
      if (picture_.depth() != CV_8U) return "has no 8 bits a channel";
      if (picture_.channels() == 1)
        picture_.copyTo(grey_);
      else
        cv::cvtColor(picture_, grey_,
                     picture_.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
      image = {grey_.cols, grey_.rows, {}, orientation_};
      for (int y = 0; y < grey_.rows; ++y)
        image.pixel.insert(image.pixel.end(), grey_.ptr(y), grey_.ptr(y) + grey_.cols);
      return "";
    });
  }

 private:
  // Returns the driver's stamp if it is on this clock, else the present time.
  double cameraTime() const {
    const double now = steadySeconds(), stamp = capture_.get(cv::CAP_PROP_POS_MSEC) / 1e3;
    return stamp <= now && stamp > now - 1 ? stamp : now;
  }

  cv::VideoCapture capture_;
  std::unique_ptr<PictureTimes> times_;
  cv::Mat picture_, grey_;
  int orientation_ = 1;
};

std::string openFile(const std::string& path, std::unique_ptr<VideoReader>& out) {
  return guarded([&]() -> std::string {
    cv::VideoCapture capture(path, cv::CAP_FFMPEG);
    if (!capture.isOpened()) return "cannot be read as a video";
    out = std::make_unique<CaptureReader>(std::move(capture), std::make_unique<PictureTimes>(path));
    return "";
  });
}

std::string openCamera(int number, std::unique_ptr<VideoReader>& out) {
  return guarded([&]() -> std::string {
    cv::VideoCapture capture(number, cv::CAP_V4L2);
    if (!capture.isOpened())
      return "there is no /dev/video" + std::to_string(number) + " that can be opened";
    out = std::make_unique<CaptureReader>(std::move(capture), nullptr);
    return "";
  });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const VideoLibrary* patinaVideoLibrary() {
  static constexpr VideoLibrary kLibrary{openFile, openCamera};
  static const bool quiet = [] {
    cv::setNumThreads(1);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return true;
  }();
  (void)quiet;
  return &kLibrary;
}

} // namespace patina
