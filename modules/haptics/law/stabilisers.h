// Stabilisers that a scene needs on a device, and their parameters (F13, MATH 2.3).
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "haptics/law/passivity_stage.h"
#include "haptics/loop_model/stability_limit.h"
#include "scene/device_model.h"
#include "scene/haptic_properties.h"

namespace patina {

struct CouplingPlan {
  double stiffness = 0;   // k_c [N/m]
  double damping = 0;     // B of spring and surface together [N s/m]
  double max_damping = 0; // upper bound of the surface's own larger damping
};

// Lateral coupling of relief and roughness (lateral_stage.h).
struct LateralPlan {
  double stiffness = 0; // k_l [N/m]
  double damping = 0;   // B parallel to the spring [N s/m]
  // maxStableCurvature() [1/m]; objects below it are not coupled.
  double max_stable_curvature = std::numeric_limits<double>::infinity();
  double coupling = std::numeric_limits<double>::infinity(); // k_c of the coupling, if any [N/m]
};

struct StabiliserPlan {
  std::optional<CouplingPlan> coupling;   // absent: no stage
  std::optional<LateralPlan> lateral;     // absent: no stage
  std::optional<PassivitySpec> passivity; // absent: no stage
  // K* of the loop without stabilisers, with the scene's damping [N/m]; absent without a device.
  std::optional<double> predicted_limit;
  std::string why; // "stiffness 1e+05 N/m, limit 1001 N/m"; empty without coupling and passivity
  std::string
      lateral_why; // "texture 6514 N/m along the surface at 3.3 N, limit 1001 N/m"; or empty

  double seriesStiffness(double stiffness) const; // in series with the coupling, if any [N/m]
};

// Sampled loop of `device` with the scene's damping.
SampledLoop sceneLoop(const HapticProperties& haptics, const DeviceModel& device,
                      const HandModel& hand = {});

// Virtual coupling for a device, independent of the surface. B = 0.017 m/T and at least m times
// 12/s, less if encoder noise would be noticeable (0.03 N a step), more if the scene has more, at
// most a fifth of the damping that is unstable by itself. k_c: half of K* with that B, at least 0.4
// of the linear stability limit, whose margin is below two.
CouplingPlan planCoupling(const HapticProperties& haptics, const DeviceModel& device);

// Lateral coupling for a texture that is stiffer along the surface than the loop allows: B and k_c
// of planCoupling(). k_l is limited so that the damping b + B s^2 exceeds what sampling k_l s costs
// by b/2, for any share s of the tip's motion that a texture leaves to the spring: k_l <= sqrt(2 b
// B) / (T/2 + n T).
LateralPlan planLateral(const HapticProperties& haptics, const DeviceModel& device);

// Largest second derivative [1/m] of a texture that keeps a stability margin of two along the
// surface with the device's damping alone. The bound holds for any pressure, because the servo
// applies at most force_limit [N].
double maxStableCurvature(double force_limit, const DeviceModel& device);

// Plans the stabilisers. Without `chosen` there is none if the device model is absent or the
// stability margin is two or more, else the coupling. A chosen stabiliser without a device model
// uses DeviceModel{}. For painted surfaces `haptics` is the worst case (painted_range.h) and
// max_damping the largest damping [N s/m], which must be stable too. max_curvature: of the scene's
// textures [1/m]; if unstable along the surface, the lateral coupling is added unless `chosen`
// excludes couplings.
StabiliserPlan planStabilisers(const HapticProperties& haptics,
                               const std::optional<DeviceModel>& device,
                               const std::optional<Stabilisers>& chosen,
                               std::optional<double> max_damping = {}, double max_curvature = 0);

} // namespace patina
