// The data of a scan: camera poses, the probe's samples, and the path computed from both.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace patina {

// Pose of the marker rig from the tracker (A04), in the camera's frame, which is also the path's.
struct CameraPose {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // origin of the probe's frame [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // camera_from_probe
  double sigma_position = 0.2e-3; // standard deviation of each axis [m]
  double sigma_angle = 5e-3;      // the same about each axis [rad]
  // The markers are not where the rig's file has them, so that neighbouring poses share their
  // errors, which no filter averages out.
  bool rig_doubted = false;
};

// One sample of the probe (A01 to A03); accelerations are specific forces, with gravity.
struct ProbeSample {
  double t = 0;                         // [s]
  double force = 0;                     // along the probe's axis, pressing is positive [N]
  std::array<double, 4> acceleration{}; // a1u a1v a2u a2v [m/s^2]
};

// One reading of the probe's gyroscope, if it has one, on the clock of its samples.
struct RateSample {
  double t = 0;             // [s]
  Vec3 rate = Vec3::Zero(); // in the probe's frame [rad/s]
};

// Names of the four axes, in the order of ProbeSample::acceleration.
inline constexpr std::array<const char*, 4> kAxisNames{"a1u", "a1v", "a2u", "a2v"};

// One measuring axis of an accelerometer, in the probe's frame.
struct AccelerometerAxis {
  Vec3 position;  // [m]
  Vec3 direction; // unit
};

// Calibration of a probe (A05). The defaults describe a pen held by its shaft: two bi-axial
// accelerometers that share the shaft's direction z.
struct ProbeModel {
  Vec3 tip = Vec3(0, 0, -0.12); // in the probe's frame, which is the frame of the markers [m]
  std::array<AccelerometerAxis, 4> axes{{{Vec3(0, 0, -0.07), Vec3::UnitX()},
                                         {Vec3(0, 0, -0.07), Vec3::UnitZ()},
                                         {Vec3(0, 0, -0.05), Vec3::UnitY()},
                                         {Vec3(0, 0, -0.05), Vec3::UnitZ()}}};
  double acceleration_step = 0.015 * 9.80665; // A02 [m/s^2]
  double acceleration_noise = 0.02;           // standard deviation before quantisation [m/s^2]
  double force_step = 0.02;                   // A03 [N]
  double force_noise = 0.005;                 // [N]
  double rate_noise = 0.003; // gyroscope, deviation of each axis of a reading [rad/s]

  // Variances include quantisation as white noise of a twelfth of the squared step.
  double accelerationVariance() const {
    return acceleration_noise * acceleration_noise + acceleration_step * acceleration_step / 12;
  }
  double forceVariance() const { return force_noise * force_noise + force_step * force_step / 12; }
};

// A time interval without data.
struct Gap {
  double from, to; // [s]
};

// Reason why a pose was used or rejected; not_finite includes a negative sigma.
enum class PoseVerdict { used, outlier, not_finite, repeated, backwards };
std::string_view nameOf(PoseVerdict verdict);

// A filtered sample of the tip.
struct PathSample {
  double t = 0;                                                    // [s]
  Vec3 position = Vec3::Zero();                                    // tip [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); // camera_from_probe
  double sigma = std::numeric_limits<double>::infinity();          // rms of the position's axes [m]
  double sigma_angle = std::numeric_limits<double>::infinity();    // rms over the axes [rad]
  double force = 0;                                                // [N]; 0 without a probe
  bool touching = false; // contact by force (contact.h); false without a probe
  bool gap = false;      // no used pose is near; the path is predicted here, with a larger `sigma`
};

} // namespace patina
