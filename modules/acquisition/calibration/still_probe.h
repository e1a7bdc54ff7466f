// What a probe's accelerometers show while it is held still in many attitudes tells their axes,
// their biases and where gravity points (A05).
#pragma once

#include <optional>

#include "acquisition/scan_samples.h"

namespace patina {

struct StillProbe {
  Vec3 gravity = Vec3::Zero();            // in the camera's frame, 9.80665 m/s^2 long
  std::array<Vec3, 4> directions;         // of the axes a1u a1v a2u a2v, in the probe's frame, unit
  std::array<double, 4> bias{};           // [m/s^2]
  std::array<double, 4> bias_deviation{}; // [m/s^2]
  std::array<double, 4> gain{};           // 1 where readings are in m/s^2; the fit takes it to be 1
  double force_zero = 0;                  // what the force shows while nothing is pressed [N]
  double rms = 0;                         // of the readings about the fit [m/s^2]
  std::array<double, 4> deviation{};      // of each axis' direction [rad]
  std::size_t attitudes = 0;              // in which it was still
};

// Half seconds in which neither the camera nor the probe shows a movement count, those of one hold
// together as one attitude; the probe must be in the air. `model` tells the axes roughly, to 40
// degrees or so. Nothing with fewer than eight, or where they are too alike to tell axes from
// biases.
std::optional<StillProbe> fitStillProbe(const std::vector<CameraPose>& poses,
                                        const std::vector<ProbeSample>& samples,
                                        const ProbeModel& model);

} // namespace patina
