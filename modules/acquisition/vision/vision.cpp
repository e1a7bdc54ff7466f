#include "acquisition/loaded/vision.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <type_traits>

// OpenCV 4.7 moved its markers from the library `aruco` to `objdetect` and changed their interface.
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace patina {
namespace {

struct Named {
  const char* name;
  int value;
};
constexpr Named kFamilies[] = {{"4x4_50", cv::aruco::DICT_4X4_50},
                               {"4x4_100", cv::aruco::DICT_4X4_100},
                               {"4x4_250", cv::aruco::DICT_4X4_250},
                               {"4x4_1000", cv::aruco::DICT_4X4_1000},
                               {"5x5_50", cv::aruco::DICT_5X5_50},
                               {"5x5_100", cv::aruco::DICT_5X5_100},
                               {"5x5_250", cv::aruco::DICT_5X5_250},
                               {"5x5_1000", cv::aruco::DICT_5X5_1000},
                               {"6x6_50", cv::aruco::DICT_6X6_50},
                               {"6x6_100", cv::aruco::DICT_6X6_100},
                               {"6x6_250", cv::aruco::DICT_6X6_250},
                               {"6x6_1000", cv::aruco::DICT_6X6_1000},
                               {"7x7_50", cv::aruco::DICT_7X7_50},
                               {"7x7_100", cv::aruco::DICT_7X7_100},
                               {"7x7_250", cv::aruco::DICT_7X7_250},
                               {"7x7_1000", cv::aruco::DICT_7X7_1000},
                               {"aruco_original", cv::aruco::DICT_ARUCO_ORIGINAL},
                               {"apriltag_16h5", cv::aruco::DICT_APRILTAG_16h5},
                               {"apriltag_25h9", cv::aruco::DICT_APRILTAG_25h9},
                               {"apriltag_36h10", cv::aruco::DICT_APRILTAG_36h10},
                               {"apriltag_36h11", cv::aruco::DICT_APRILTAG_36h11}};

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

// Throws Error with the known names, which a cv::Exception does not list.
const Named& familyNamed(const std::string& name) {
  const Named* found = std::find_if(std::begin(kFamilies), std::end(kFamilies),
                                    [&](const Named& each) { return name == each.name; });
  if (found != std::end(kFamilies)) return *found;
  std::string names;
  for (const Named& each : kFamilies) names += (names.empty() ? "" : " ") + std::string(each.name);
  throw std::runtime_error("'" + name + "' is no family of markers; there are " + names);
}

// Before OpenCV 4.7 a dictionary comes as a pointer.
template <typename Found> cv::aruco::Dictionary dictionaryIn(const Found& found) {
  if constexpr (std::is_same_v<Found, cv::aruco::Dictionary>)
    return found;
  else
    return *found;
}

std::string family(const std::string& name, MarkerFamily& out) {
  return guarded([&]() -> std::string {
    const cv::aruco::Dictionary dictionary =
        dictionaryIn(cv::aruco::getPredefinedDictionary(familyNamed(name).value));
    out.name = name;
    out.side = dictionary.markerSize;
    out.code.clear();
    for (int id = 0; id < dictionary.bytesList.rows; ++id) {
      const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(
          dictionary.bytesList.rowRange(id, id + 1), dictionary.markerSize);
      std::uint64_t code = 0;
      for (int i = 0; i < out.side * out.side; ++i)
        code = code << 1 | bits.at<std::uint8_t>(i / out.side, i % out.side);
      out.code.push_back(code);
    }
    return "";
  });
}

std::string chessboard(const GreyFrame& image, int columns, int rows, std::vector<Vec2>& corners) {
  return guarded([&]() -> std::string {
    corners.clear();
    const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.row(0)));
    std::vector<cv::Point2f> found;
    if (!cv::findChessboardCorners(view, {columns, rows}, found)) return "";
    for (const cv::Point2f& point : found) corners.emplace_back(point.x, point.y);
    return "";
  });
}

std::string calibrate(const std::vector<BoardView>& views, CameraFit& fit) {
  return guarded([&]() -> std::string {
    std::vector<std::vector<cv::Point3f>> boards;
    std::vector<std::vector<cv::Point2f>> pixels;
    for (const BoardView& view : views) {
      boards.emplace_back();
      pixels.emplace_back();
      for (const Vec2& point : view.board)
        boards.back().emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()), 0);
      for (const Vec2& point : view.pixel)
        pixels.back().emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()));
    }
    cv::Mat matrix, distortion, turns, shifts, deviations, outer, each;
    fit.rms = cv::calibrateCamera(boards, pixels, {fit.camera.width, fit.camera.height}, matrix,
                                  distortion, turns, shifts, deviations, outer, each, 0,
                                  {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-12});
    fit.camera.fx = matrix.at<double>(0, 0);
    fit.camera.fy = matrix.at<double>(1, 1);
    fit.camera.cx = matrix.at<double>(0, 2);
    fit.camera.cy = matrix.at<double>(1, 2);
    for (int i = 0; i < 5; ++i)
      fit.camera.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
    for (int i = 0; i < 9; ++i)
      fit.deviation[static_cast<std::size_t>(i)] = deviations.at<double>(i);
    return "";
  });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const VisionLibrary* patinaVisionLibrary() {
  static constexpr VisionLibrary kLibrary{family, chessboard, calibrate};
  // Keeps the library from starting threads that disturb the servo.
  static const bool quiet = [] {
    cv::setNumThreads(1);
    return true;
  }();
  (void)quiet;
  return &kLibrary;
}

} // namespace patina
