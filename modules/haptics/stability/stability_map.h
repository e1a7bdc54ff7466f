// Where on a surface the sampled loop would buzz, before anyone touches it: K*(x)/K (MATH 2.1.7).
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/triangle_mesh.h"
#include "haptics/stability/local_stiffness.h"

namespace patina {

// What the loop bears: K* [N/m] of the scene's device (DeviceModel{} where none is set), exact for
// one direction and without a hand (stability_limit.h), with the coupling where the scene chooses
// it or gets it by itself (planStabilisers). Of painted damping the least and the most are tried,
// and the worse one counts everywhere.
struct LoopLimits {
  double plain = 0;  // where nothing but the device damps: along the surface
  double tied = 0;   // along what holds the tip so that the coupling damps it in full
  double damped = 0; // where damping helps: along the normal, and while friction sticks
  double whirl = 0;  // b^2 / (m K*): what the device's damping holds against a whirl
  double coupling = std::numeric_limits<double>::infinity(); // k_c [N/m], if any

  bool coupled() const { return std::isfinite(coupling); }
  // k / K of two springs in a row, by which the coupling softens a surface.
  double softening(double stiffness) const;
};
LoopLimits loopLimits(const Scene& scene, std::span<const FeltObject> objects = {});

// Where lambda_min is below -kGrip a light grip no longer keeps the tip in its place: it slips off,
// as from a ridge, a thin spike or a narrow leg.
inline constexpr double kGrip = 300; // [N/m]

// K of the material at the point, painted or not. K*(x)/K: above 1 the loop is stable at this
// point, below 1 it buzzes. What the wall asks for in each direction over what the loop bears in
// it, the worst direction; and, each on its own, the terms that a frictionless wall does not show:
// friction in stick is K in every direction, the magnet is k_m along the normal, just outside.
// Infinite if nothing needs bearing.
//
// Directions are the eigenvectors of the whole matrix (MATH 2.1.7). Those of its symmetric part
// are the safe side of it: beside creases they see up to three K where nothing buzzes. A complex
// pair is a force that goes round: the tip whirls at an angular frequency w where Im / w exceeds
// what is left of the damping.
//
// Where the tip slips off (kGrip) the wall counts as a plane of stiffness K: what its directions
// would need besides is left before it has grown.
//
// The criterion is local and linear: it says that the tip, held there, oscillates, not how far.
// Encoder and dry friction of the device (MATH 2.2) and the passivity controller are left out.
double stabilityRatio(const LocalStiffness& at, const Scene& scene, const LoopLimits& limits);

struct StabilityMap {
  // One a vertex; NaN where the force jumps within the step of the differences, and where there is
  // no contact.
  std::vector<float> ratio;
  std::vector<float> least; // lambda_min of the wall [N/m], one a vertex; NaN without contact
  std::vector<bool> slips;  // one a vertex: the tip slips off
  LoopLimits limits;
  std::size_t worst = 0;  // vertex of the smallest ratio
  double worst_ratio = 0; // NaN if there is none
  // Counts of vertices.
  std::size_t buzzing = 0; // ratio below 1
  std::size_t slipping = 0;
  std::size_t jumping = 0; // the force jumps
};

// Every vertex of `mesh`, which lies on the field's surface, pressed as StiffnessProbe says: with
// 1 N, or the force limit where that is less. Of a harder press it says nothing: texture is stiffer
// along the surface in proportion, and the lateral coupling is planned for the force limit. Some
// 5 to 15 us a vertex on one core; polls progress, throws Cancelled, and as compileStages().
StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress,
                          std::span<const FeltObject> objects = {});

} // namespace patina
