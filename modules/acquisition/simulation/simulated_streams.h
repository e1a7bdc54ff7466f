// What camera and probe would report of a simulated hand, with their noise and their faults.
#pragma once

#include "acquisition/scan_samples.h"
#include "acquisition/simulation/simulated_hand.h"

namespace patina {

inline const Vec3 kGravity(0, 0, -9.80665); // where z is up [m/s^2]

struct SimulatedCamera {
  Pose camera_from_world = Pose::Identity();
  double rate = 30;               // [Hz]
  double sigma_position = 0.2e-3; // each axis [m]
  double sigma_angle = 4.7e-3;    // about each axis [rad]
  double outliers = 0;            // the part of the poses that are wrong
  double outlier_size = 32e-3;    // by how much, standard deviation of each axis [m]
  std::vector<Gap> gaps;          // without a pose
};
// Both streams begin at 0 and last as long as the hand moves.
std::vector<CameraPose> simulateCamera(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedCamera& camera, std::uint32_t seed);

struct SimulatedProbe {
  double rate = 500;                                    // A01 [Hz]
  std::array<double, 4> bias{0.06, -0.04, 0.05, -0.07}; // what calibration left [m/s^2]
  double force_bias = 0;                                // [N]
  double clock_offset = 0; // shown minus true time at the beginning [s]
  double clock_skew = 0;   // by how much the probe's clock runs faster
  std::vector<Gap> gaps;   // samples that were lost
};
std::vector<ProbeSample> simulateProbe(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedProbe& stream, std::uint32_t seed);

// What a filter should find at these times of the true clock, in the camera's frame.
std::vector<PathSample> truthAt(const SimulatedHand& hand, const Pose& camera_from_world,
                                const std::vector<double>& times);

} // namespace patina
