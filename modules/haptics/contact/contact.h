// The record that one servo tick fills in.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/types.h"
#include "haptics/contact/surface_jacobian.h"
#include "scene/paint/channels.h"

namespace patina {

// One tick. Each group is set by the stage that is named above it; a stage that comes later may
// change what is said to be its own as well. "The contact stage" is ProxyStage, RayStage or the
// plane's.
struct Contact {
  // tick()
  Vec3 tip = Vec3::Zero();      // [m], world
  Vec3 velocity = Vec3::Zero(); // [m/s], backward difference; VelocityFilterStage: filtered
  double dt = 0;                // [s], since the last finite tip

  // tick(): the snapshot's base; MaterialStage: what is painted; TextureStiffnessStage, MagnetStage
  Material material;
  // In the world; that of stiffness is 0 unless it is painted and the force conservative.
  MaterialGradients gradients;

  // The contact stage; relief and roughness lower it, down to no contact
  bool touching = false;
  bool deep = false; // where contact is was found from inside, not by the way in
  bool snap = false; // the contact point runs by itself: no friction, no work of the hand; also
                     // LateralStage
  // What stuck no longer does: a jump a tick ago (tick()), or an edit has moved the surface.
  bool lets_go = false;
  int samples = 0; // field evaluations (T-K06d); also OffsetStage
  // What phi - iso at the tip is at least [voxels], out of contact; 0 in contact. Infinite: nobody
  // has looked.
  double clearance = std::numeric_limits<double>::infinity();
  Vec3 drawn = Vec3::Zero();     // [m], of c since the last tick; 0 where contact begins
  Vec3 normal = Vec3::Zero();    // unit, outward; zero if there is no direction (K05)
  Vec3 candidate = Vec3::Zero(); // frictionless VCP c
  double depth = 0;              // d = |c - x| [m]
  // What holds c, the one that bears most first: c - x is the sum of load times normal, but where c
  // was held back (snap): there the loads are those of a c that had arrived.
  struct WallLoad {
    Vec3 normal = Vec3::Zero(); // unit, outward
    double load = 0;            // [m]
  };
  std::array<WallLoad, 3> wall{};
  int walls = 0;
  // The nearest point of the original surface: where contact is seen and where an edit acts.
  // Differs from the candidate by the tip's radius and the offset (OffsetStage). The tip where
  // nothing is near. MagnetStage where it pulls, as normal and vcp.
  Vec3 surface = Vec3::Zero();
  Vec3 vcp = Vec3::Zero(); // p, after FrictionStage; the tip if not touching

  // How surface moves with the tip: ProxyStage where one wall holds it, else pulledBack() for
  // whichever stage asks first
  std::optional<SurfaceJacobian> jacobian;

  // OwnerStage
  std::int32_t object = 0; // that surface belongs to, where that matters

  // LateralStage
  Vec3 aside = Vec3::Zero(); // [m], over the surface: relief and roughness are read at
                             // surface + aside
  double lateral = 0;        // [N/m], of the spring that ties it so; 0 = none, aside is 0

  // ReliefStage and RoughnessStage
  Vec3 slope = Vec3::Zero(); // normal is along n - slope
  double relief_step = 0;    // [m], by which relief moved the VCP this tick, at most

  // FrictionStage
  double stick_radius = 0; // [m], how far p may be from c while it sticks; 0 = it does not
  double slip_step = 0;    // [m], how far the VCP let go this tick by a rule of its own; also
                           // RayStage

  // MagnetStage
  bool attracted = false; // out of contact, pulled
  double attraction = 0;  // 1 where it pulls, less where its band fades out

  // SpringStage or CouplingStage
  double stiffness = 0; // K at the contact [N/m]; of the whole law, where a coupling softens it
  // Spring, magnet, coupling, damping, stiffness slope, passivity and limit, one upon another
  Vec3 force = Vec3::Zero(); // on the hand [N]
  // Magnet, stiffness slope and passivity
  double known_step = 0; // [N], a step of the force that the model itself makes this tick

  // LimitStage
  bool fault = false;
};

} // namespace patina
