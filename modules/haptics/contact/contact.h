// Record that one servo tick fills in.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/types.h"
#include "haptics/contact/surface_jacobian.h"
#include "scene/paint/channels.h"

namespace patina {

// State of one tick. The comment above each group names the stage that sets it; later stages may
// change it. "Contact stage" means ProxyStage, RayStage or the plane's.
struct Contact {
  // tick()
  Vec3 tip = Vec3::Zero();      // [m], world
  Vec3 velocity = Vec3::Zero(); // [m/s], backward difference, or filtered
  double dt = 0;                // time since the last finite tip [s]

  // tick(): the snapshot's base; MaterialStage: painted values; TextureStiffnessStage, MagnetStage
  Material material;
  // World frame; stiffness: 0 unless it is painted and the force conservative.
  MaterialGradients gradients;

  // Contact stage; relief and roughness may end the contact.
  bool touching = false;
  bool deep = false; // contact was found from inside, without an approach path
  // True if the contact point moves without the tip, as past a medial axis; friction and the energy
  // observer skip this tick. LateralStage also sets it.
  bool snap = false;
  // True if stiction must be released: a jump in the last tick (tick()), or an edit.
  bool release_stick = false;
  int samples = 0; // field evaluations (T-K06d); OffsetStage adds its own
  // Lower bound of phi - iso at the tip [voxels]; 0 in contact, infinite if not evaluated.
  double clearance = std::numeric_limits<double>::infinity();
  Vec3 displacement = Vec3::Zero(); // movement of c since the last tick [m]; 0 at first contact
  Vec3 normal = Vec3::Zero();       // unit, outward; zero if undefined (K05)
  Vec3 frictionless_point = Vec3::Zero(); // c: contact point without friction
  double depth = 0;                       // d = |c - x| [m]
  // Walls that constrain c, by decreasing multiplier: c - x is the sum of multiplier times normal.
  // If c is still on its way (snap), the multipliers are those of its destination.
  struct WallLoad {
    Vec3 normal = Vec3::Zero(); // unit, outward
    double multiplier = 0;      // Lagrange multiplier [m]
  };
  std::array<WallLoad, 3> wall{};
  int walls = 0;
  // Nearest point of the original surface, where the contact is displayed and edits apply. It
  // differs from c by tip radius and offset (OffsetStage) and is the tip if nothing is near.
  // MagnetStage sets surface, normal and vcp while it attracts.
  Vec3 surface = Vec3::Zero();
  Vec3 vcp = Vec3::Zero(); // p, after FrictionStage; the tip without contact

  // Derivative of `surface` with respect to the tip. ProxyStage sets it for a single wall;
  // otherwise pulledBack() computes it on first use.
  std::optional<SurfaceJacobian> jacobian;

  // OwnerStage
  std::int32_t object = 0; // object that `surface` belongs to, if the stages need it

  // LateralStage
  Vec3 lateral_offset = Vec3::Zero(); // tangential offset of the texture lookup [m]: relief and
                                      // roughness are evaluated at surface + lateral_offset
  double lateral_stiffness = 0;       // tangential spring [N/m]; 0: none, offset 0

  // ReliefStage and RoughnessStage
  Vec3 slope = Vec3::Zero(); // `normal` is parallel to n - slope
  double relief_jump = 0;    // bound of the contact point's movement by relief in this tick [m]

  // FrictionStage
  double stick_radius = 0; // largest distance of p from c while sticking [m]; 0: slipping
  // sudden release of the contact point in this tick [m]; also of RayStage's snap
  double slip_jump = 0;

  // MagnetStage
  bool attracted = false; // attracted without contact
  double attraction = 0;  // 1 inside the magnet's range, less where it fades out

  // SpringStage or CouplingStage
  double stiffness = 0; // stiffness at the contact, with a coupling in series [N/m]
  // The stages add to it: spring, magnet, coupling, damping, stiffness gradient, passivity, limit.
  Vec3 force = Vec3::Zero(); // force on the hand [N]
  // Magnet, stiffness gradient and passivity
  double expected_force_jump = 0; // force jump of the model itself in this tick [N]

  // LimitStage
  bool fault = false;
};

} // namespace patina
