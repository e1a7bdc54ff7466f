// Stick-slip friction that limits the movement of the contact point (K09, K10).
#pragma once

#include <optional>

#include "field/sampling/field_sampler.h"
#include "haptics/law/stage.h"
#include "scene/scene.h"

namespace patina {

inline constexpr double kFrictionDepthReference = 1e-3; // d_ref of K10 [m]

struct FrictionMemory {
  struct StickState {
    Vec3 anchor;                  // anchor p_s of K09, world
    Vec3 frictionless_point;      // c in the last tick
    Vec3 lagged_tip;              // low-pass filtered tip position on the surface
    Vec3 last_lag = Vec3::Zero(); // vector from tip to lagged tip in the last tick
    bool slipping = false;        // ends when |p_s - c| < mu_d d
  };
  std::optional<StickState> stick; // present in contact with friction

  bool slipping() const noexcept { return stick && stick->slipping; }
};

// mu_s and mu_d come from the material; painted mu_s < mu_d acts like mu_s = mu_d. The contact
// point p sticks until |p - c| exceeds mu_s d, then follows the frictionless point c at mu_d d
// until |p - c| < mu_d d. Direction of p - c while slipping: paper         from c to the last p,
// which lags by up to mu_d d on a curved path; displacement  against the tip's motion in the
// tangent plane at c, free of the field's noise, averaged over 0.05 voxel against the tip's noise,
// and extrapolated to the end of the tick by the last rotation.
class FrictionStage final : public ForceStage {
 public:
  // `friction`: only the values that no material has. raised: relief lifts the surface off phi =
  // tip_radius, so that p is not projected onto it.
  FrictionStage(const FieldSampler& sampler, double tip_radius, const Friction& friction,
                bool raised);

  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  Vec3 againstMotion(const Contact& contact, FrictionMemory::StickState& stick) const noexcept;
  Vec3 ontoSurface(const Contact& contact, const Vec3& offset, double length) const noexcept;

  FieldSampler sampler_;
  double depth_gain_;
  Friction::SlipDirection slip_;
  bool raised_;
  double iso_; // [voxels]
  double lag_; // [m]
};

} // namespace patina
