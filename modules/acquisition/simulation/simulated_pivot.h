// Poses of a probe that rotates about its fixed tip (A05).
#pragma once

#include "acquisition/values/scan_samples.h"

namespace patina {

struct SimulatedPivot {
  Vec3 tip{0, 0, -0.12}; // in the probe's frame [m]
  Vec3 point{0, 0, 0.5}; // fixed point in the camera's frame [m]
  int poses = 200;
  double cone = 0.785; // largest tilt in any direction, with any rotation about the shaft [rad]
  double sigma_position = 0.3e-3, sigma_angle = 5.236e-3; // [m], [rad]
  double outliers = 0.1, outlier_size = 15e-3; // share of wrong poses, and their error [m]
};
std::vector<CameraPose> simulatePivot(const SimulatedPivot& pivot, std::uint32_t seed);

} // namespace patina
