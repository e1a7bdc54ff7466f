#include "acquisition/video/video.h"

#include <chrono>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "acquisition/video/picture_times.h"

namespace patina {
namespace {

// Nothing that is thrown, not even for want of memory, may leave the library.
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
  // `times`: of a file; nullptr: a camera.
  CaptureReader(cv::VideoCapture capture, std::unique_ptr<PictureTimes> times)
      : capture_(std::move(capture)), times_(std::move(times)) {
    const double said = capture_.get(cv::CAP_PROP_FPS),
                 frames = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (std::isfinite(said) && said > 0) rate = said;
    if (times_ && frames > 0 && frames < 1e9) count = static_cast<int>(frames);
    // OpenCV turns them as the container says, and tells by how many degrees clockwise.
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
  // The driver's stamp is the frame's own, where it has one on this clock.
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
    if (!capture.isOpened()) return "is no video that can be read";
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
