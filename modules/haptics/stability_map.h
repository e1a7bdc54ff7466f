// Where on a surface the sampled loop would buzz, before anyone touches it: K*(x)/K (F3, 2.1.7).
#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "geometry/triangle_mesh.h"
#include "haptics/local_stiffness.h"

namespace patina {

// What the loop bears: K* [N/m] of the scene's device (DeviceModel{} where none is set), exact for
// one direction and without a hand (stability_limit.h), with the coupling where the scene chooses
// it or gets it by itself (planStabilisers).
struct LoopLimits {
  double plain = 0;     // where nothing but the device damps: along the surface
  double damped = 0;    // where damping helps: along the normal, and while friction sticks
  double softening = 1; // by the coupling: k / K of two springs in a row
  bool coupled = false;
};
LoopLimits loopLimits(const Scene& scene);

// K*(x)/K: above 1 the loop is stable at this point, below 1 it buzzes. What the wall asks for in
// each direction over what the loop bears in it, the worst direction; and, each on its own, the
// terms that a frictionless wall does not show: friction in stick is K in every direction, the
// magnet is k_m along the normal, just outside. Infinite if nothing needs bearing.
//
// The criterion is local and linear: it says that the tip, held there, oscillates, not how far.
// Encoder and dry friction of the device (2.2) and the passivity controller are left out.
double stabilityRatio(const LocalStiffness& at, const Scene& scene, const LoopLimits& limits);

struct StabilityMap {
  std::vector<float> ratio; // one a vertex; NaN where there is no direction or no contact
  std::vector<float> least; // lambda_min of the wall [N/m], one a vertex
  LoopLimits limits;
  std::size_t worst = 0;   // vertex of the smallest ratio
  double worst_ratio = 0;  // NaN if there is none
  double uncertainty = 0;  // of the wall's stiffness there, as a fraction of its lambda_max
  std::size_t buzzing = 0; // vertices below 1
};

// Every vertex of `mesh`, which lies on the field's surface, pressed as StiffnessProbe says. Some
// 5 us a vertex on one core; polls progress, throws Cancelled, and as compileStages().
StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress);

} // namespace patina
