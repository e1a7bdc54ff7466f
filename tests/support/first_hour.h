// The pictures of a lab's first hour: a printed board that is held everywhere, and a rig
// that was glued by hand and is waved.
#pragma once

#include <algorithm>
#include <filesystem>
#include <random>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/simulation/simulated_rig.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_code.h"
#include "core/file.h"
#include "support/printed_board.h"

namespace patina::test {

// The board's middle stands at a pixel, turned about the camera's axes [rad].
inline Pose boardAt(const Board& board, const Camera& camera, const Vec2& pixel, const Vec2& turn,
                    double distance = 0.35) {
  Pose pose = Pose::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(turn.x(), Vec3::UnitX()) * Eigen::AngleAxisd(turn.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(3.14159265358979, Vec3::UnitX()))
          .toRotationMatrix();
  const Vec3 middle = board.square / 2 * Vec3(board.columns, -board.rows, 0);
  const Vec3 ray((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 1);
  pose.translation() = distance * ray - pose.linear() * middle;
  return pose;
}

// Draws a ChArUco board by looking up 25 points of each pixel, a tenth of FrameRenderer's time.
class DrawnBoard {
 public:
  DrawnBoard(const Camera& camera, const Board& board)
      : camera_(camera), board_(board), family_(markerFamily(board.family)) {
    for (int y = 0; y <= camera.height; ++y)
      for (int x = 0; x <= camera.width; ++x)
        corners_.push_back(*normalizedPoint(camera, Vec2(x - 0.5, y - 0.5)));
  }
  // `camera_from_board` has y up, as in printedBoard(). The lens's blur is .7 px.
  GreyFrame draw(const Pose& camera_from_board, std::uint32_t seed) const {
    Eigen::Matrix3d plane; // the board's plane, y up, at z = 0
    plane << camera_from_board.linear().leftCols<2>(), camera_from_board.translation();
    const Eigen::Matrix3d inverse = plane.inverse();
    std::vector<double> sharp;
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x) {
        double sum = 0;
        for (int k = 0; k < 25; ++k) {
          const double u = (k % 5 + 0.5) / 5, v = (k / 5 + 0.5) / 5;
          const Vec2 ray = (1 - v) * ((1 - u) * rayAt(x, y) + u * rayAt(x + 1, y)) +
                           v * ((1 - u) * rayAt(x, y + 1) + u * rayAt(x + 1, y + 1));
          const Vec2 p = (inverse * ray.homogeneous()).hnormalized();
          sum += isBlack(p.x() / board_.square, -p.y() / board_.square) ? 20. / 25 : 215. / 25;
        }
        sharp.push_back(sum);
      }
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1.5);
    GreyFrame image{camera_.width, camera_.height, {}};
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x) {
        double sum = 0;
        for (int k = 0; k < 9; ++k) {
          const int column = std::clamp(x + k % 3 - 1, 0, camera_.width - 1),
                    row = std::clamp(y + k / 3 - 1, 0, camera_.height - 1);
          const double weight = (k % 3 == 1 ? 0.5 : 0.25) * (k / 3 == 1 ? 0.5 : 0.25);
          sum += weight * sharp[index(row * camera_.width + column)];
        }
        image.pixel.push_back(static_cast<std::uint8_t>(std::clamp(sum + noise(random), 0., 255.)));
      }
    return image;
  }

 private:
  const Vec2& rayAt(int x, int y) const { return corners_[index(y * (camera_.width + 1) + x)]; }
  bool isBlack(double x, double y) const { // x and y count squares from the top left
    if (x < 0 || y < 0 || x >= board_.columns || y >= board_.rows) return false;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    if ((column + row) % 2 == 0) return true;
    const int side = family_.side + 2, before = row * board_.columns / 2 + column / 2;
    const double share = board_.marker / board_.square;
    const double u = (x - column - 0.5) / share + 0.5, v = (y - row - 0.5) / share + 0.5;
    if (u < 0 || v < 0 || u >= 1 || v >= 1) return false;
    const int i = static_cast<int>(u * side) - 1, j = static_cast<int>(v * side) - 1;
    if (i < 0 || j < 0 || i >= family_.side || j >= family_.side) return true;
    const int place = family_.side * family_.side - 1 - (j * family_.side + i);
    return (family_.code[index(before)] >> place & 1) == 0;
  }

  Camera camera_;
  Board board_; // has an even number of columns
  const MarkerFamily& family_;
  std::vector<Vec2> corners_; // corners of pixels on the plane z = 1
};

// A board that is held still in 24 poses, all over a picture of 640 x 480; ten frames a second.
inline void writeBoardFrames(const std::filesystem::path& folder, const Camera& camera,
                             const Board& board) {
  const DrawnBoard drawn(camera, board);
  std::filesystem::create_directories(folder / "frames");
  std::string list = frameListHeader();
  for (int i = 0; i < 24; ++i) {
    const Vec2 place(190 + 130 * (i % 3), 140 + 100 * (i / 3 % 3));
    const Pose pose = boardAt(board, camera, i < 9 ? place : Vec2(300 + 2 * i, 200 + 3 * i),
                              0.45 * Vec2(std::sin(2.4 * i), std::cos(2.4 * i)), 0.34 + 0.002 * i);
    writeGrey(folder / "frames" / (frameStem(i) + ".png"),
              drawn.draw(pose, static_cast<std::uint32_t>(i)));
    list += std::to_string(i) + "," + std::to_string(0.1 * i) + "\n";
  }
  writeFileAtomically(folder / "frames.csv", list);
}

// The rig of rig.json, glued by hand, waved before the camera for 20 s.
struct GluedRig {
  std::vector<RigMarker> markers;
  Vec3 tip;

  explicit GluedRig(const std::filesystem::path& rig)
      : markers(madeByHand(readMarkers(rig), {0.3e-3, 8.7e-3, 1.01}, 4)),
        tip(readRig(rig).probe.tip) {}
  void writeWave(const std::filesystem::path& folder, const Camera& camera) const {
    WavedProbe waved;
    waved.tip = tip;
    waved.seconds = 20;
    CaptureSettings capture;
    capture.rate = 15;
    Progress progress;
    writeFrames(
        folder, camera, [&](double t) { return wavedPose(waved, t); }, waved.seconds, markers,
        capture, progress);
    std::filesystem::remove(folder / "camera.yml"); // a camera does not know its own
  }
  // The error of a calibrated rig's tip, in the frame of its first marker.
  double tipError(const std::filesystem::path& rig) const {
    const Vec3 found = readMarkers(rig)[0].probe_from_marker.inverse() * readRig(rig).probe.tip;
    return (found - markers[0].probe_from_marker.inverse() * tip).norm();
  }
};

} // namespace patina::test
