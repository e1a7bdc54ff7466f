// A camera model, its grey pictures and the markers that are searched in them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

// Distortion model of a lens.
enum class LensModel {
  // Radial and tangential polynomials (Brown 1966) over a second polynomial, a thin prism (Weng,
  // Cohen & Herniou 1992) and a tilted sensor, as OpenCV has them:
  // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y.
  brown,
  // A polynomial of the angle to the axis (Kannala & Brandt 2006), OpenCV's fisheye: k1 k2 k3 k4.
  fisheye
};

// Pinhole camera as in OpenCV: z forward, x right, y down; the first pixel's center is (0, 0).
struct Camera {
  int width = 0, height = 0;             // [px]
  double fx = 0, fy = 0, cx = 0, cy = 0; // [px]
  std::array<double, 14> distortion{};   // coefficients of the lens model; unused ones are 0
  LensModel lens = LensModel::brown;
};

// Grey picture; the top row comes first.
struct GreyFrame {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixel;
  int orientation = 1; // EXIF orientation by which the picture was turned (orientation.h)

  const std::uint8_t* row(int y) const {
    return pixel.data() + static_cast<std::ptrdiff_t>(y) * width;
  }
};

// Family of square markers with codes of one size. A bit is 1 where the square is white; bits go
// row by row from the top left, the first one is the most significant. A black border one bit wide
// surrounds them.
struct MarkerFamily {
  std::string name;                // "4x4_50", "apriltag_36h11"
  int side = 0;                    // bits per side
  int max_correction = 0;          // largest Hamming distance to a code that is accepted
  std::vector<std::uint64_t> code; // indexed by id
};

// A marker of the rig. Its frame has its origin in the marker's center, x to the right and y to the
// top of its code, z towards the viewer.
struct RigMarker {
  std::string family;
  int id = 0;
  double size = 0; // side of the black square [m]
  Pose probe_from_marker = Pose::Identity();
  // Standard deviations by a calibration, place and turn each axis; 0: made by hand, not
  // calibrated.
  double size_deviation = 0, place_deviation = 0, angle_deviation = 0; // [m], [m], [rad]

  // Corners of the black square in the probe's frame, clockwise from the top left.
  std::array<Vec3, 4> corners() const {
    const double h = size / 2;
    return {probe_from_marker * Vec3(-h, h, 0), probe_from_marker * Vec3(h, h, 0),
            probe_from_marker * Vec3(h, -h, 0), probe_from_marker * Vec3(-h, -h, 0)};
  }
};

} // namespace patina
