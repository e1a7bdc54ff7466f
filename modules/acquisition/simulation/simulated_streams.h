// Simulated streams of camera and probe for a hand, with noise and faults.
#pragma once

#include "acquisition/simulation/simulated_hand.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

inline const Vec3 kGravity(0, 0, -9.80665); // z is up [m/s^2]

struct SimulatedCamera {
  Pose camera_from_world = Pose::Identity();
  double rate = 30;               // [Hz]
  double sigma_position = 0.2e-3; // each axis [m]
  double sigma_angle = 4.7e-3;    // about each axis [rad]
  double outliers = 0;            // share of wrong poses
  double outlier_size = 32e-3;    // their error, standard deviation of each axis [m]
  std::vector<Gap> gaps;          // times without poses
};
// Both streams begin at 0 and last as long as the hand moves.
std::vector<CameraPose> simulateCamera(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedCamera& camera, std::uint32_t seed);

struct SimulatedProbe {
  double rate = 500;                                    // A01 [Hz]
  std::array<double, 4> bias{0.06, -0.04, 0.05, -0.07}; // residual of the calibration [m/s^2]
  double force_bias = 0;                                // [N]
  double clock_offset = 0;                              // stamp minus true time at the start [s]
  double clock_skew = 0;                                // relative excess rate of the probe's clock
  std::vector<Gap> gaps;                                // times without samples
  Vec3 rate_bias = Vec3(0.004, -0.006, 0.003);          // gyroscope [rad/s]
};
std::vector<ProbeSample> simulateProbe(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedProbe& stream, std::uint32_t seed);

// Returns the readings of the probe's gyroscope at the times of its samples, from the rotation
// within one sample's time.
std::vector<RateSample> simulateRates(const SimulatedHand& hand, const ProbeModel& probe,
                                      const SimulatedProbe& stream, std::uint32_t seed);

// Returns the true path at these times of the true clock, in the camera's frame.
std::vector<PathSample> truthAt(const SimulatedHand& hand, const Pose& camera_from_world,
                                const std::vector<double>& times);

} // namespace patina
