// OpenCV's projection of a point: an oracle that shares no code with ours.
#pragma once

#include <opencv2/calib3d.hpp>
#include <vector>

#include "acquisition/values/camera.h"

namespace patina::test {

inline Vec2 projectedByOpenCv(const Camera& camera, const Vec3& point) {
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  const cv::Vec3d none(0, 0, 0);
  std::vector<cv::Point2d> pixel;
  if (camera.lens == LensModel::fisheye) {
    const cv::Vec4d k(camera.distortion[0], camera.distortion[1], camera.distortion[2],
                      camera.distortion[3]);
    cv::fisheye::projectPoints(points, pixel, none, none, matrix, k);
  } else {
    cv::projectPoints(points, none, none, matrix,
                      std::vector<double>(camera.distortion.begin(), camera.distortion.end()),
                      pixel);
  }
  return {pixel[0].x, pixel[0].y};
}

} // namespace patina::test
