#include "app/studies/haptics/measured_limit.h"

#include <cmath>
#include <limits>

#include "app/studies/haptics/bisection.h"
#include "haptics/law/plane.h"

namespace patina {
namespace {

constexpr double kDepth = 1e-3;     // [m]
constexpr double kAmplitude = 1e-6; // [m]
constexpr double kTolerance = 1e-4;

bool oscillationDecays(const HapticProperties& haptics, SimulationSpec spec) {
  HapticProperties unlimited = haptics;
  unlimited.force_limit = std::numeric_limits<double>::infinity();
  spec.depth = kDepth;
  spec.press = haptics.stiffness * kDepth;
  spec.speed = kAmplitude * std::sqrt(haptics.stiffness / (spec.device.mass + spec.hand.mass));
  Progress progress;
  const SimulationReport run = simulate(*planeSnapshot(unlimited, {}), spec, progress);
  return run.rms_velocity < run.rms_early;
}

} // namespace

double measuredStiffnessLimit(HapticProperties haptics, const SimulationSpec& spec, double low,
                              double high) {
  return bisected(low, high, kTolerance, [&](double stiffness) {
    haptics.stiffness = stiffness;
    return oscillationDecays(haptics, spec);
  });
}

} // namespace patina
