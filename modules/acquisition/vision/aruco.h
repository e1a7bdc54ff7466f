// OpenCV 4.7 moved its markers from the library `aruco` to `objdetect` and changed their interface.
// This header gives both versions the same two functions; a family is one of OpenCV's `DICT_`
// numbers.
#pragma once

#include <vector>

#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>

namespace patina {

inline cv::aruco::Dictionary arucoFamily(int family) {
  return cv::aruco::getPredefinedDictionary(family);
}

inline void findAruco(const cv::Mat& view, int family, int refinement,
                      std::vector<std::vector<cv::Point2f>>& corners, std::vector<int>& ids) {
  cv::aruco::DetectorParameters parameters;
  parameters.cornerRefinementMethod = refinement;
  cv::aruco::ArucoDetector(arucoFamily(family), parameters).detectMarkers(view, corners, ids);
}

} // namespace patina
#else
#include <opencv2/aruco.hpp>

namespace patina {

inline cv::aruco::Dictionary arucoFamily(int family) {
  return *cv::aruco::getPredefinedDictionary(family);
}

inline void findAruco(const cv::Mat& view, int family, int refinement,
                      std::vector<std::vector<cv::Point2f>>& corners, std::vector<int>& ids) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  cv::aruco::detectMarkers(view, cv::aruco::getPredefinedDictionary(family), corners, ids,
                           parameters);
}

} // namespace patina
#endif
