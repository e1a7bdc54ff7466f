// Friction as a limit to the movement of the VCP (K09, K10).
#pragma once

#include <optional>

#include "field/sampling/field_sampler.h"
#include "haptics/stages/stage.h"
#include "scene/scene.h"

namespace patina {

inline constexpr double kFrictionDepthReference = 1e-3; // d_ref of K10 [m]

struct FrictionMemory {
  struct Grip {
    Vec3 stuck;                // p_s of K09, world
    Vec3 candidate;            // c, a tick ago
    Vec3 trail;                // trails the tip closely over the surface: where it comes from
    Vec3 slide = Vec3::Zero(); // from tip to trail, a tick ago
    bool slipping = false;     // until |p_s - c| < mu_d d
  };
  std::optional<Grip> grip; // while the tip touches and there is friction

  bool slipping() const noexcept { return grip && grip->slipping; }
};

// mu_s and mu_d are the material's; painted so that mu_s < mu_d, a surface sticks as it slides.
// The VCP p stays where it is until |p - c| exceeds mu_s d, then trails the frictionless candidate
// c at mu_d d until |p - c| < mu_d d. Where p trails:
//  paper         in the direction from c to where p was: on a curved path it lags by up to mu_d d;
//  displacement  against the motion over the tangent plane at c, measured at the tip, so that the
//                field's noise is not in it, over 0.05 voxel, so that the tip's noise does not
//                choose the direction; carried on to the end of the tick by the turn since the last
//                one.
class FrictionStage final : public ForceStage {
 public:
  // Of `friction` only what a material has not. raised: the surface that is felt is not phi =
  // tip_radius (relief), and there is nothing to bring p back to.
  FrictionStage(const FieldSampler& sampler, double tip_radius, const Friction& friction,
                bool raised);

  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  Vec3 againstMotion(const Contact& contact, FrictionMemory::Grip& grip) const noexcept;
  Vec3 ontoSurface(const Contact& contact, const Vec3& offset, double length) const noexcept;

  FieldSampler sampler_;
  double depth_gain_;
  Friction::SlipDirection slip_;
  bool raised_;
  double iso_;   // voxels
  double trail_; // [m]
};

} // namespace patina
