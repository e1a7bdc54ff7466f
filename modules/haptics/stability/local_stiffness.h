// How stiff the surface is at one of its points, all directions told apart: what a sampled loop has
// to bear there (MATH 2.1.7).
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "haptics/servo/snapshot.h"

namespace patina {

struct LocalStiffness {
  Vec3 tip = Vec3::Zero();    // [m], pressed in
  Vec3 normal = Vec3::Zero(); // of the force there, unit, outward
  double depth = 0;           // [m], beneath the surface that is felt, along the way in
  double force = 0;           // [N], magnitude there
  Material material;          // there
  double lateral = 0;         // k_l [N/m] there; 0 = no lateral coupling
  // -dF/dx [N/m] of the frictionless wall. Not symmetric where the interpolated direction is not
  // the gradient of the interpolated depth: beside creases and near a medial axis.
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  // Extreme eigenvalues of its symmetric part [N/m]: no direction is stiffer or less stiff.
  double lambda_max = 0;
  double lambda_min = 0; // negative: the tip slips off, as from a ridge
  // The contact point ran off while the tip stood still, as from a ridge: what is told is where it
  // came to rest.
  bool slips = false;
  // Largest change of an entry of `matrix` [N/m] when the step is halved: what the number is good
  // for. At a crease the stiffness itself varies within a voxel, and this says so.
  double uncertainty = 0;
};

// Presses the tip into a scene's surface and differences the force of the scene's own stages, each
// tick with the memory of a straight way in from outside, so that thin parts are held as they are
// in the servo. Left out are what depends on the path or on time: friction, damping, magnet,
// stabilisers and force limit; stability_map.h adds what they contribute. Two things of the
// stabilisers are in: how texture yields by the lateral coupling, and that behind a coupling the
// same force presses deeper.
//
// The step is 1/4 voxel to either side: shorter ones see the edges of facets, over which the
// contact point hops, and longer ones less than the field tells. Nearer to the surface than two
// steps it is half the depth. Where relief or roughness is felt, differences over the step s and
// over half of it are extrapolated: a wave of number k is off by (k s)^4 / 480 of itself.
class StiffnessProbe {
 public:
  // Throws as compileStages().
  StiffnessProbe(const Scene& scene, std::shared_ptr<const SurfaceField> field,
                 std::span<const FeltObject> objects = {});

  // `point` on or near the surface, no further than the band; pressed in against the field's
  // direction there, by `depth` [m] beneath what is felt, relief included, or, without, by 1 N over
  // the stiffness there (by the force limit where that is less). nullopt where there is no
  // direction or no force. Any thread.
  std::optional<LocalStiffness> at(const Vec3& point, std::optional<double> depth = {}) const;

 private:
  Contact settled(ContactMemory& memory, const Vec3& tip) const;
  Eigen::Matrix3d differenced(const ContactMemory& at, const Vec3& tip, double step) const;

  std::shared_ptr<const HapticSnapshot> wall_;
  FieldSampler sampler_;
  double reach_;  // [m], from the surface out to where it is felt
  double raised_; // [m], of which the most that relief may be
  double press_;  // [N]
  double coupling_ = std::numeric_limits<double>::infinity(); // k_c
  bool painted_;
};

} // namespace patina
