#include "acquisition/video/video.h"

#include <chrono>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

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
  CaptureReader(cv::VideoCapture capture, bool camera)
      : capture_(std::move(capture)), camera_(camera) {
    const double said = capture_.get(cv::CAP_PROP_FPS),
                 frames = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (std::isfinite(said) && said > 0) rate = said;
    if (!camera && frames > 0 && frames < 1e9) count = static_cast<int>(frames);
  }

  std::string next(GreyFrame& image, double& t, bool& ended) override {
    return guarded([&]() -> std::string {
      ended = !capture_.read(picture_);
      if (ended) return "";
      // The driver's stamp is the frame's own, where it has one on this clock.
      const double now = steadySeconds(), stamp = capture_.get(cv::CAP_PROP_POS_MSEC) / 1e3;
      t = camera_ && stamp <= now && stamp > now - 1 ? stamp : now;
      if (picture_.depth() != CV_8U) return "has no 8 bits a channel";
      if (picture_.channels() == 1)
        picture_.copyTo(grey_);
      else
        cv::cvtColor(picture_, grey_,
                     picture_.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
      image = {grey_.cols, grey_.rows, {}};
      for (int y = 0; y < grey_.rows; ++y)
        image.pixel.insert(image.pixel.end(), grey_.ptr(y), grey_.ptr(y) + grey_.cols);
      return "";
    });
  }

 private:
  cv::VideoCapture capture_;
  cv::Mat picture_, grey_;
  bool camera_;
};

std::string openFile(const std::string& path, std::unique_ptr<VideoReader>& out) {
  return guarded([&]() -> std::string {
    cv::VideoCapture capture(path, cv::CAP_FFMPEG);
    if (!capture.isOpened()) return "is no video that can be read";
    out = std::make_unique<CaptureReader>(std::move(capture), false);
    return "";
  });
}

std::string openCamera(int number, std::unique_ptr<VideoReader>& out) {
  return guarded([&]() -> std::string {
    cv::VideoCapture capture(number, cv::CAP_V4L2);
    if (!capture.isOpened())
      return "there is no /dev/video" + std::to_string(number) + " that can be opened";
    out = std::make_unique<CaptureReader>(std::move(capture), true);
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
