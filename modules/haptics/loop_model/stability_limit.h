// Largest stable stiffness of a sampled wall (F3, MATH 2.1.2 to 2.1.4).
#pragma once

#include <optional>

#include "scene/device_model.h"

namespace patina {

// Dynamics that the hand adds to the device.
struct HandModel {
  double mass = 0;      // [kg]
  double damping = 0;   // [N s/m]
  double stiffness = 0; // spring to the hand's target position [N/m]
  bool operator==(const HandModel&) const = default;
};

// Loop of one direction, without dry friction and encoder: a zero-order-hold force F = -K x - B v,
// v the backward difference of x, acts on device and hand `delay` samples after x was read.
struct SampledLoop {
  double mass = 0.1;              // [kg], > 0
  double damping = 0.5;           // device and hand [N s/m]
  double hand_stiffness = 0;      // [N/m]
  double period = 1e-3;           // T [s], > 0
  int delay = 0;                  // n [samples]
  double virtual_damping = 0;     // B [N s/m]
  std::optional<double> cutoff{}; // first-order filter of v [Hz]; absent: none
};
SampledLoop sampledLoop(const DeviceModel& device, const HandModel& hand = {});

// Spectral radius of the transition matrix; above 1 the loop is unstable. With stiffness 0 and no
// hand spring the position drifts freely and is left out.
double spectralRadius(const SampledLoop& loop, double stiffness);

// K*: the loop is stable for 0 < K < K*; 0 if it is never stable (no damping, or too much virtual
// damping). Relative error 1e-9, or 1e-12 m/(b T) if larger.
double stiffnessLimit(const SampledLoop& loop);

// B* with K = 0: virtual damping from B* on is unstable by itself; about 2m/T without delay.
double dampingLimit(const SampledLoop& loop);

// Linear stability condition (Gil et al. 2009): (b + B) / (T/2 + n T).
double linearStabilityLimit(const SampledLoop& loop);

} // namespace patina
