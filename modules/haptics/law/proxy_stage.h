// Contact on any shape by a proxy on the surface (Ruspini et al. 1997; P01 to P12).
#pragma once

#include "haptics/contact/proxy.h"
#include "haptics/law/stage.h"

namespace patina {

// Largest speed of the contact point without the tip, as past the medial axis of a limb: grid side
// lengths per second, 0.1 m/s on an object of 100 mm. It bounds the change of the spring force per
// tick by 2 K |dx| + K v_s dt (P12).
inline constexpr double kSnapSides = 0.9;

// Sets touching, snap, normal, frictionless_point, vcp (the same), depth, surface and walls. A tip
// from outside is tracked from its path's first crossing of the surface; a tip inside at its first
// tick moves out along the gradient. The proxy stays on its side of thin parts and edges.
class ProxyStage final : public ForceStage {
 public:
  // iso [m]: tip radius plus offset plus the relief envelope. lipschitz: bound of |grad phi|, >= 1,
  // larger with baked relief. curved: computes the Jacobian that pulls gradients back.
  ProxyStage(const FieldSampler& sampler, double iso, double lipschitz = 1, bool curved = false);

  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool enter(const Vec3& x, const Vec3& from, const ContactMemory& memory, Contact& contact,
             Vec3& c) const noexcept;

  FieldSampler sampler_;
  ProxySearch search_;
  double voxel_;
  double iso_; // [voxels]
  double lipschitz_, per_lipschitz_;
  double snap_speed_; // [m/s]
  bool curved_;
};

} // namespace patina
