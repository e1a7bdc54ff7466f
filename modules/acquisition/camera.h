// A camera, what it sees, and the markers that it looks for.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

// The formula of a lens's distortion.
enum class LensModel {
  // Radial and tangential polynomials (Brown 1966) over a second polynomial (Claus & Fitzgibbon
  // 2005), a thin prism (Weng, Cohen & Herniou 1992) and a tilted sensor, as OpenCV has them:
  // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y.
  brown,
  // A polynomial of the angle to the axis (Kannala & Brandt 2006), OpenCV's fisheye: k1 k2 k3 k4.
  fisheye
};

// A pinhole behind a lens, as OpenCV has it: z looks forward, x right, y down; the middle of the
// first pixel is (0, 0).
struct Camera {
  int width = 0, height = 0;             // [px]
  double fx = 0, fy = 0, cx = 0, cy = 0; // [px]
  std::array<double, 14> distortion{};   // coefficients of the lens model; those it lacks are 0
  LensModel lens = LensModel::brown;
};

// The top row first.
struct GreyFrame {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixel;
  int orientation = 1; // EXIF's, by which it was turned to be as it is shown (orientation.h)

  const std::uint8_t* row(int y) const {
    return pixel.data() + static_cast<std::ptrdiff_t>(y) * width;
  }
};

// Square markers of one size of code. A bit is 1 where it is white; rows from the top, each from
// the left, the first bit the highest. Around the bits lies a black border one bit wide.
struct MarkerFamily {
  std::string name;    // "4x4_50", "apriltag_36h11"
  int side = 0;        // bits a side
  int correctable = 0; // wrong bits that are forgiven: the rest tells codes from what is none
  std::vector<std::uint64_t> code; // by id
};

// A marker on a body of them. Its frame: middle, x to the right and y to the top of its code, z
// towards who reads it.
struct RigMarker {
  std::string family;
  int id = 0;
  double size = 0; // of the black square's side [m]
  Pose probe_from_marker = Pose::Identity();

  // Of the black square, in the probe's frame: top left, top right, bottom right, bottom left.
  std::array<Vec3, 4> corners() const {
    const double h = size / 2;
    return {probe_from_marker * Vec3(-h, h, 0), probe_from_marker * Vec3(h, h, 0),
            probe_from_marker * Vec3(h, -h, 0), probe_from_marker * Vec3(-h, -h, 0)};
  }
};

} // namespace patina
