// Pictures of ChArUco boards, printed and photographed.
#pragma once

#include <random>

#include "acquisition/calibration/board.h"
#include "acquisition/simulation/simulated_frames.h"

namespace patina::test {

// A printed board: its white squares carry codes, its black ones are markers without any. The
// layout is OpenCV's since 4.6, or the earlier one, whose top left square is white if the number of
// rows is even.
inline std::vector<PrintedMarker> printedBoard(const Board& board, bool white_first = false) {
  const MarkerFamily& family = markerFamily(board.family);
  std::vector<PrintedMarker> printed;
  int id = 0;
  for (int y = 0; y < board.rows; ++y)
    for (int x = 0; x < board.columns; ++x) {
      PrintedMarker one{{board.family, 0, board.square, Pose::Identity()}, family.side, 0};
      one.place.probe_from_marker.translation() = board.square * Vec3(x + 0.5, -(y + 0.5), 0);
      if (((x + y) % 2 == 1) != white_first) {
        one.code = family.code[static_cast<std::size_t>(id++)];
        one.place.size = board.marker;
      } else {
        one.margin = 0;
      }
      printed.push_back(one);
    }
  return printed;
}

// A pose in front of the camera at `distance`, tilted by up to 0.5, moved aside by a tenth [m,
// rad].
inline Pose boardPose(const Board& board, std::mt19937& random, double distance) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double a = unit(random), b = unit(random), c = unit(random), x = unit(random),
               y = unit(random), z = unit(random);
  Pose pose = Pose::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(3.14159265358979, Vec3::UnitX()) *
       Eigen::AngleAxisd(0.5 * a, Vec3::UnitX()) * Eigen::AngleAxisd(0.5 * b, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.3 * c, Vec3::UnitZ()))
          .toRotationMatrix();
  const Vec3 middle = board.square / 2 * Vec3(board.columns, -board.rows, 0);
  pose.translation() = distance * Vec3(0.1 * x, 0.1 * y, 1 + 0.1 * z) - pose.linear() * middle;
  return pose;
}

inline FrameLook boardLook() {
  FrameLook look;
  look.ground = look.white;
  look.waves = 0;
  return look;
}

} // namespace patina::test
