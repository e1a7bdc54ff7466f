// The virtual contact point (VCP) as a constrained closest point, in grid coordinates (P01 to P12).
// Nothing here knows metres, so that nothing depends on the size of the model.
#pragma once

#include <optional>

#include "field/sampling/field_sampler.h"
#include "haptics/contact/half_spaces.h"
#include "haptics/contact/surface_jacobian.h"

namespace patina {

// How a wall's normal turns along a way, as the last tick saw it; 0 where it is not known.
struct WallTurn {
  Vec3 along = Vec3::Zero();     // unit
  Vec3 per_voxel = Vec3::Zero(); // [1/voxel]
};

// What contact remembers: where the VCP is, and the walls about it as they were last seen. Walls
// that are absent are looked up again.
struct Proxy {
  Vec3 c = Vec3::Zero();
  Walls walls;
  WallTurn turn;   // of a lone wall
  double lent = 0; // work that moves of c gave of late, over the stiffness [voxel^2]
};

struct ProxyMove {
  bool touching = false;
  bool snap = false; // the VCP ran by itself, as far as it may in a tick: past the axis of a limb
  int samples = 0;
  double clearance = 0; // phi - iso at x, out of contact
  bool smooth = false;  // held by one wall, from which c is perpendicular to the tip
  std::optional<SurfaceJacobian> jacobian; // if smooth and it is asked for
  WallProjection held; // by which of the proxy's walls, and how hard; if smooth, load[0] alone
};

// c(t) = local argmin |y - x|^2 subject to phi(y) >= iso, continued from where it was. Only the
// surface's neighbourhood is read, whatever the depth of x.
//
// What shapes may give (P11): about creases, where c depends on the way, |c - x| never grows by a
// move of c. On a smooth surface c is that of x whatever came before; there the sampled normals
// give a little, which is kept count of over 100 voxels of way and taken back out of them: some uJ
// a loop of a few mm at 500 N/m, and on any way less than 8e-5 K voxel^2 a voxel.
class ProxySearch {
 public:
  // steepness: how much faster than the distance to the surface phi may fall, >= 1.
  // curved: ProxyMove::jacobian is asked for.
  ProxySearch(const FieldSampler& sampler, double iso, double steepness = 1,
              bool curved = false) noexcept
      : sampler_(&sampler), iso_(iso), per_steepness_(1 / steepness), curved_(curved) {}

  // In contact: x is the new tip, from the last (proxy.c where contact begins, and nothing pulls
  // yet); `ball` bounds how far c goes, but for a last step out to the surface of at most .1 voxel.
  // Leaves proxy.c on the surface, or says that contact has ended.
  ProxyMove follow(const Vec3& x, const Vec3& from, double ball, Proxy& proxy) const noexcept;

  // Where the way from a free point to `to` first meets the surface, on its free side to 1e-5, or
  // a free place within a voxel of it where 128 looks ended; parts thinner than 1/16 voxel may be
  // missed. height: phi - iso at from and at to, where known.
  std::optional<Vec3> firstCrossing(const Vec3& from, double height_from, const Vec3& to,
                                    std::optional<double> height_to, int& samples,
                                    double grazing = 0) const noexcept;

  // For a tip that is inside without having come from anywhere: out along the direction that the
  // field has, from the coarse nodes where it is deeper than the band. Nothing if that leads to no
  // surface.
  std::optional<Vec3> seekSurface(const Vec3& x, int& samples) const noexcept;

  // Brings a point that was on another surface (an edit's, P11) onto this one, on the side where it
  // is. False where the way to x is free.
  bool seat(const Vec3& x, Vec3& c, int& samples) const noexcept;

  double heightAt(const Vec3& q) const noexcept { return sampler_->phiAtGrid(q) - iso_; }

 private:
  struct Aim;
  struct Seen;
  struct Tried;
  Seen look(const Vec3& q, double own = 0) const noexcept;
  static WallPlane wallAt(const Vec3& z, const Seen& seen) noexcept;
  bool slide(const Vec3& x, const Vec3& from, double ball, Proxy& proxy, ProxyMove& move,
             Tried& tried) const noexcept;
  bool isFree(const Vec3& from, double height_from, const Vec3& to, double height_to,
              int& samples) const noexcept;
  Aim aimAt(const Vec3& x, const Walls& walls, const Vec3& start, double ball, const Vec3& anchor,
            double trust) const noexcept;

  const FieldSampler* sampler_;
  double iso_; // voxels
  double per_steepness_;
  bool curved_;
};

} // namespace patina
