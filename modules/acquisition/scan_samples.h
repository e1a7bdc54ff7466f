// What a scan is made of: poses that a camera saw, the probe's stream, and the path made of both.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace patina {

// The rig of markers as a tracker saw it (A04), in the camera's frame, which is the path's.
struct CameraPose {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // of the probe frame's origin [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // camera_from_probe
  double sigma_position = 0.2e-3; // standard deviation of each axis [m]
  double sigma_angle = 5e-3;      // the same about each axis [rad]
};

// One reading of the probe (A01 to A03). Accelerations are specific forces: at rest they show what
// holds against gravity.
struct ProbeSample {
  double t = 0;                         // [s]
  double force = 0;                     // along the probe's axis, pressing is positive [N]
  std::array<double, 4> acceleration{}; // a1u a1v a2u a2v [m/s^2]
};

// One measuring axis of an accelerometer, in the probe's frame.
struct AccelerometerAxis {
  Vec3 position;  // [m]
  Vec3 direction; // unit
};

// What calibration says of a probe (A05). The defaults are those of a pen held by its shaft: two
// bi-axial accelerometers that share the shaft's direction z.
struct ProbeModel {
  Vec3 tip = Vec3(0, 0, -0.12); // in the probe's frame, whose origin the markers carry [m]
  std::array<AccelerometerAxis, 4> axes{{{Vec3(0, 0, -0.07), Vec3::UnitX()},
                                         {Vec3(0, 0, -0.07), Vec3::UnitZ()},
                                         {Vec3(0, 0, -0.05), Vec3::UnitY()},
                                         {Vec3(0, 0, -0.05), Vec3::UnitZ()}}};
  double acceleration_step = 0.015 * 9.80665; // A02 [m/s^2]
  double acceleration_noise = 0.02;           // before the step, standard deviation [m/s^2]
  double force_step = 0.02;                   // A03 [N]
  double force_noise = 0.005;                 // [N]

  // Steps count as white noise of a twelfth of their square.
  double accelerationVariance() const {
    return acceleration_noise * acceleration_noise + acceleration_step * acceleration_step / 12;
  }
  double forceVariance() const { return force_noise * force_noise + force_step * force_step / 12; }
};

// A time without what should be there.
struct Gap {
  double from, to; // [s]
};

// Why a pose was or was not taken; not_finite: or its sigma is below 0.
enum class PoseVerdict { used, outlier, not_finite, repeated, backwards };
std::string_view nameOf(PoseVerdict verdict);

// A filtered sample of the tip.
struct PathSample {
  double t = 0;                                                    // [s]
  Vec3 position = Vec3::Zero();                                    // of the tip [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // camera_from_probe
  double sigma = std::numeric_limits<double>::infinity(); // of the position, rms of the axes [m]
  double sigma_angle = std::numeric_limits<double>::infinity(); // rms of the axes [rad]
  double force = 0;                                             // [N]; 0 without a probe
  bool touching = false; // by force (contact.h); false without a probe
  bool gap = false;      // no pose was used close by: bridged, see `sigma`
};

} // namespace patina
