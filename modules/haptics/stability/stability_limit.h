// How stiff a sampled wall may be before it buzzes (F3, MATH 2.1.2 to 2.1.4).
#pragma once

#include <optional>

#include "scene/device_model.h"

namespace patina {

// What the hand adds to the device it holds.
struct HandModel {
  double mass = 0;      // [kg]
  double damping = 0;   // [N s/m]
  double stiffness = 0; // [N/m], of a spring to where the hand wants to be
  bool operator==(const HandModel&) const = default;
};

// The loop of one direction: device and hand under a held force, F = -K x - B v, v the backward
// difference of x, applied `delay` samples after x was read. Dry friction and encoder are left out.
struct SampledLoop {
  double mass = 0.1;              // [kg], > 0
  double damping = 0.5;           // [N s/m], of device and hand
  double hand_stiffness = 0;      // [N/m]
  double period = 1e-3;           // T [s], > 0
  int delay = 0;                  // n, samples
  double virtual_damping = 0;     // B [N s/m]
  std::optional<double> cutoff{}; // [Hz], of a first-order filter of v; absent = none
};
SampledLoop sampledLoop(const DeviceModel& device, const HandModel& hand = {});

// Largest magnitude of the eigenvalues of one sample to the next; above 1 the loop grows. With
// stiffness 0 and no hand spring the position itself, which then drifts freely, is left out.
double spectralRadius(const SampledLoop& loop, double stiffness);

// K*: the loop is stable for 0 < K < K*. 0 if it is stable for none (no damping at all, or too much
// of the virtual kind). Relative error 1e-9, or
// 1e-12 m/(b T) where that is more.
double stiffnessLimit(const SampledLoop& loop);

// B* with K = 0: from there on virtual damping itself buzzes; about 2m/T without delay.
double dampingLimit(const SampledLoop& loop);

// (b + B) / (T/2 + n T).
double ruleOfThumb(const SampledLoop& loop);

} // namespace patina
