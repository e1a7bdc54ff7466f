// Which safety nets a scene needs on a device, and how strong (F13, MATH 2.3).
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "haptics/stability/stability_limit.h"
#include "haptics/stages/passivity_stage.h"
#include "scene/device_model.h"
#include "scene/haptic_properties.h"

namespace patina {

struct CouplingPlan {
  double stiffness = 0;    // k_c [N/m]
  double damping = 0;      // B [N s/m], of spring and surface together
  double most_damping = 0; // where the surface itself has more, up to here
};

// Of relief and roughness along the surface (lateral_stage.h).
struct LateralPlan {
  double stiffness = 0; // k_l [N/m]
  double damping = 0;   // B [N s/m], beside it
  // [1/m], steadyBend(): objects of no more are felt without.
  double steady_bend = std::numeric_limits<double>::infinity();
  double coupling = std::numeric_limits<double>::infinity(); // k_c [N/m] of the coupling, if any
};

struct StabiliserPlan {
  std::optional<CouplingPlan> coupling;   // absent: no stage
  std::optional<LateralPlan> lateral;     // absent: no stage
  std::optional<PassivitySpec> passivity; // absent: no stage
  // K* of the loop without these, with the scene's own damping [N/m]; absent without a device.
  std::optional<double> predicted_limit;
  std::string why; // "stiffness 1e+05 N/m, limit 1001 N/m"; empty without coupling and passivity
  std::string
      lateral_why; // "texture 6514 N/m along the surface at 3.3 N, limit 1001 N/m"; or empty

  double softened(double stiffness) const; // [N/m], behind the coupling, if any
};

// The loop of `device` with the scene's own damping.
SampledLoop sceneLoop(const HapticProperties& haptics, const DeviceModel& device,
                      const HandModel& hand = {});

// The coupling for a device, whatever the surface: B = 0.017 m/T and at least 12 m/s, less where the
// encoder would make it felt as noise (0.03 N a step), more where the scene itself has more, at
// most a fifth of the damping that buzzes by itself; k_c half of K* with that B, but no less than
// 0.4 of the rule of thumb, where the margin is below two.
CouplingPlan planCoupling(const HapticProperties& haptics, const DeviceModel& device);

// For a texture that is stiffer along the surface than the loop bears: B and k_c of planCoupling(),
// the latter no more than what keeps the damping b + B s^2 over that which sampling k_l s takes by
// b/2, at any share s of the tip's motion that a texture of any stiffness leaves to the spring:
// k_l <= sqrt(2 b B) / (T/2 + n T).
LateralPlan planLateral(const HapticProperties& haptics, const DeviceModel& device);

// The largest second derivative [1/m] of a texture that leaves a margin of two along the surface,
// where the device alone damps, however hard it is pressed. The servo never gives more than
// force_limit [N], so that no more than this times the second derivative is felt.
double steadyBend(double force_limit, const DeviceModel& device);

// chosen absent = automatic: nothing without a device model, nothing where the scene is stable with
// a margin of two, else the coupling. A chosen stabiliser without a device model takes
// DeviceModel{}. Of painted surfaces `haptics` are the hardest (painted_range.h), and most_damping
// [N s/m] the most damped; it must be as stable there. bend: of the scene's sharpest texture [1/m];
// where that is not steady along the surface there is the lateral coupling, unless the choice
// leaves couplings out.
StabiliserPlan planStabilisers(const HapticProperties& haptics,
                               const std::optional<DeviceModel>& device,
                               const std::optional<Stabilisers>& chosen,
                               std::optional<double> most_damping = {}, double bend = 0);

} // namespace patina
