// Calibrates a probe's sensors (A05). Accelerometers: axes, biases and gravity from readings at
// rest in many attitudes, which the camera gives. Force sensor: zero and gain from known weights.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/values/scan_samples.h"

namespace patina {

// A reading of the force sensor under a known weight.
struct KnownForce {
  double force = 0;   // pressing force [N]
  double reading = 0; // reading of the probe, in any unit
};

struct ForceFit {
  double zero = 0, gain = 1;         // force = gain (reading - zero)
  double zero_deviation = 0;         // [unit of the reading]
  double gain_deviation = 0;         // [N per unit of the reading]
  double rms = 0;                    // residuals of the readings used [N]
  std::vector<std::size_t> rejected; // outliers
};

// Fits a line; the weights are taken as exact and up to a quarter of the readings may be wrong.
// Returns nullopt for fewer than four readings or three different forces, or if the reading hardly
// grows with the force.
std::optional<ForceFit> fitForce(const std::vector<KnownForce>& readings);

struct AccelerometerCalibration {
  Vec3 gravity = Vec3::Zero();            // in the camera's frame, 9.80665 m/s^2 long
  std::array<Vec3, 4> directions;         // axes a1u a1v a2u a2v in the probe's frame, unit
  std::array<double, 4> bias{};           // [m/s^2]
  std::array<double, 4> bias_deviation{}; // [m/s^2]
  std::array<double, 4> gain{};           // 1 for readings in m/s^2; the fit assumes 1
  double force_zero = 0;                  // force reading without load [N]
  double rms = 0;                         // residuals of the readings [m/s^2]
  std::array<double, 4> deviation{};      // standard deviation of each direction [rad]
  std::size_t attitudes = 0;              // number of static attitudes used
};

// Uses windows of half a second without movement of camera and probe; consecutive windows of one
// static pose count as one attitude. The probe must be in the air. `model` needs the axes within
// about 40 degrees. Returns nullopt for fewer than eight attitudes, or if they are too similar to
// separate axes from biases.
std::optional<AccelerometerCalibration>
calibrateAccelerometers(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& model);

} // namespace patina
