// Poses of a probe that turns about its tip, which stands still (A05).
#pragma once

#include "acquisition/scan_samples.h"

namespace patina {

struct SimulatedPivot {
  Vec3 tip{0, 0, -0.12}; // in the probe's frame [m]
  Vec3 point{0, 0, 0.5}; // where it stands, in the camera's [m]
  int poses = 200;
  double cone =
      0.785; // how far the probe leans to all sides, turned about itself as it likes [rad]
  double sigma_position = 0.3e-3, sigma_angle = 5.236e-3; // [m], [rad]
  double outliers = 0.1, outlier_size = 15e-3;            // a part of the poses, off by so much [m]
};
std::vector<CameraPose> simulatePivot(const SimulatedPivot& pivot, std::uint32_t seed);

} // namespace patina
