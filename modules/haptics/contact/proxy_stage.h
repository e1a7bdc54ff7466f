// Contact on any shape: the tip's proxy stays on the surface, nearest to the tip (P01 to P12).
#pragma once

#include "haptics/contact/proxy.h"
#include "haptics/stages/stage.h"

namespace patina {

// How fast the contact point may run while the tip stands still, as it does past the axis of a
// limb: grid sides a second, 0.1 m/s on an object of 100 mm. With it a tick changes the spring's
// force by 2 K |dx| + K v_s dt at most (P12).
inline constexpr double kSnapSides = 0.9;

// Sets touching, snap, normal, candidate, vcp (= candidate), depth, surface and walls.
//
// A tip that comes from outside is followed from where its way meets the surface; one that is
// inside at its first tick is brought out along the field's direction. Thin parts, corners and
// edges need nothing of their own: the proxy is on one side and stays there.
class ProxyStage final : public ForceStage {
 public:
  // iso [m]: the tip's radius, plus the offset, plus a shell about what is pulled. steepness >= 1:
  // how much faster than the distance to it the field may fall, where relief is baked in. curved:
  // whether stages pull back what lies on the surface.
  ProxyStage(const FieldSampler& sampler, double iso, double steepness = 1, bool curved = false);

  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool enter(const Vec3& x, const Vec3& from, const ContactMemory& memory, Contact& contact,
             Vec3& c) const noexcept;

  FieldSampler sampler_;
  ProxySearch search_;
  double voxel_;
  double iso_; // voxels
  double steepness_, per_steepness_;
  double snap_speed_; // [m/s]
  bool curved_;
};

} // namespace patina
