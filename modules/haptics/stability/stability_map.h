// Predicts where on a surface the sampled loop is unstable: K*(x)/K (MATH 2.1.7).
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/triangle_mesh.h"
#include "haptics/law/snapshot.h"

namespace patina {

// Local stiffness matrix of a surface, for the stability of the sampled loop (MATH 2.1.7).
struct LocalStiffness {
  Vec3 tip = Vec3::Zero();      // pressed position [m]
  Vec3 normal = Vec3::Zero();   // direction of the force there, unit, outward
  double depth = 0;             // along the approach, below the haptic surface [m]
  double force = 0;             // magnitude [N]
  Material material;            // material at the contact
  double lateral_stiffness = 0; // k_l of the lateral coupling [N/m]; 0: none
  // -dF/dx [N/m] of the frictionless wall. Not symmetric where the interpolated direction is not
  // the gradient of the interpolated depth: next to creases and near a medial axis.
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  // Extreme eigenvalues of the symmetric part [N/m], bounds for all directions.
  double lambda_max = 0;
  double lambda_min = 0; // negative: statically unstable, as on a ridge
  // True if the contact point moved away from the held tip, as on a ridge; values are final.
  bool is_unstable = false;
  // Largest change of an entry of `matrix` [N/m] when the step is halved, an error estimate. At a
  // crease it shows that the stiffness varies within a voxel.
  double uncertainty = 0;
};

// Presses the tip into the surface and differences the force of the scene's stages, starting each
// time from a straight approach from outside, so that thin parts respond as in the servo. Path- and
// time-dependent stages are excluded (friction, damping, magnet, stabilisers, force limit);
// stabilityRatio() adds their effects. Included are the lateral coupling's compliance and the
// larger depth behind a coupling.
//
// Central differences with a step of 1/4 voxel: shorter steps see the edges of facets, over which
// the contact point jumps, longer ones lose detail. Closer to the surface than two steps, the step
// is half the depth. With relief or roughness, differences over s and s/2 are extrapolated
// (Richardson); a wave of number k then has a relative error of (k s)^4 / 480.
class StiffnessProbe {
 public:
  // Throws as compileStages().
  StiffnessProbe(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                 std::span<const HapticObject> objects = {});

  // Presses at `point`, on or near the surface and within the band, against the gradient. depth [m]
  // below the haptic surface including relief; by default the depth of 1 N (or the force limit, if
  // less). Returns nullopt without a direction or a force. Any thread.
  std::optional<LocalStiffness> at(const Vec3& point, std::optional<double> depth = {}) const;

 private:
  Contact convergedContact(ContactMemory& memory, const Vec3& tip) const;
  Eigen::Matrix3d differenced(const ContactMemory& at, const Vec3& tip, double step) const;

  std::shared_ptr<const HapticSnapshot> wall_;
  FieldSampler sampler_;
  double contact_offset_; // from the field's surface to the contact without relief [m]
  double max_relief_;     // largest relief height above it [m]
  double press_;          // force of the default depth [N]
  double coupling_ = std::numeric_limits<double>::infinity(); // k_c [N/m]
  bool painted_;
};

// Stable stiffness K* [N/m] of the scene's device (DeviceModel{} by default), exact for one
// direction without a hand (stability_limit.h), with the coupling if the scene has one
// (planStabilisers). For painted damping the worse of smallest and largest applies.
struct StiffnessLimits {
  double device_only = 0;    // device damping only: along the surface
  double coupled_normal = 0; // with full coupling damping, along constrained directions
  double damped = 0;         // with all damping: along the normal, and while friction sticks
  double whirl = 0;          // b^2 / (m K*): stability limit of whirl by the device's damping
  double coupling = std::numeric_limits<double>::infinity(); // k_c [N/m], if any

  bool coupled() const { return std::isfinite(coupling); }
  // k / K of two springs in series, the factor by which the coupling softens a surface.
  double seriesFactor(double stiffness) const;
};
StiffnessLimits loopLimits(const Scene& scene, std::span<const HapticObject> objects = {});

// If lambda_min is below -kMinHandStiffness, a light grip does not hold the tip: it slips off a
// ridge, a thin spike or a narrow leg.
inline constexpr double kMinHandStiffness = 300; // [N/m]

// K*(x)/K with K of the material at the point: stable above 1, unstable below. Inverse of the
// largest ratio of demanded to stable stiffness over all directions, and of the terms that a
// frictionless wall lacks: K in every direction while friction sticks, k_m of a magnet along the
// normal. Infinite without any demand.
//
// Directions are the eigenvectors of the full matrix (MATH 2.1.7). Those of its symmetric part
// would be conservative: next to creases they give up to three K where the loop is stable. A
// complex pair is whirl (rotor dynamics): a rotating force at angular frequency w, unstable if Im /
// w exceeds the remaining damping.
//
// A statically unstable point (kMinHandStiffness) counts as a plane of stiffness K, because the tip
// leaves it before an oscillation grows.
//
// The criterion is local and linear: it predicts an oscillation of the held tip, not its amplitude.
// It excludes encoder and dry friction of the device (MATH 2.2) and the passivity controller.
double stabilityRatio(const LocalStiffness& at, const Scene& scene, const StiffnessLimits& limits);

struct StabilityMap {
  // Per vertex; NaN without contact, and where the force is discontinuous.
  std::vector<float> ratio;
  std::vector<float> least;      // lambda_min [N/m] per vertex; NaN without contact
  std::vector<bool> is_unstable; // per vertex: statically unstable
  StiffnessLimits limits;
  std::size_t worst = 0;  // vertex of the smallest ratio
  double worst_ratio = 0; // NaN if there is none
  // Vertex counts:
  std::size_t buzzing = 0; // ratio below 1
  std::size_t unstable_count = 0;
  std::size_t discontinuous_count = 0; // discontinuous force
};

// Evaluates every vertex of `mesh`, which lies on the field's surface, with StiffnessProbe at 1 N
// or the force limit, if less. Stronger presses are not covered: tangential texture stiffness grows
// in proportion, and the lateral coupling is planned for the force limit. Takes 5 to 15 us per
// vertex on one core. Polls progress; throws Cancelled, and as compileStages().
StabilityMap stabilityMap(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                          const TriangleMesh& mesh, Progress& progress,
                          std::span<const HapticObject> objects = {});

} // namespace patina
