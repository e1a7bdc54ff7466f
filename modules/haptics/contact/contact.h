// The record one servo tick fills in, and what survives it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/types.h"
#include "haptics/contact/proxy.h"
#include "scene/device_model.h"
#include "scene/paint/material_map.h"

namespace patina {

// Survives from tick to tick; owned by the servo thread. reset() = the first tick again.
struct ContactMemory {
  Vec3 last_tip = Vec3::Zero();
  bool has_last_tip = false;
  Vec3 velocity = Vec3::Zero(); // [m/s], of the filter stage, where there is one
  double gap = 0;               // [s] since last_tip, spent on ticks without a finite tip

  bool in_contact = false;
  Vec3 last_candidate = Vec3::Zero(); // [m]
  Proxy proxy;                        // of the proxy stage: its walls; c is last_candidate
  bool reseat = false;                // the surface may be another one than a tick ago
  Vec3 last_normal = Vec3::Zero();    // of the ray stage: last valid direction (K05 edge case)
  // What phi - iso at last_tip is at least [voxels], out of contact; 0 in contact. Infinite =
  // nobody has looked.
  double clearance = std::numeric_limits<double>::infinity();

  Vec3 stuck = Vec3::Zero(); // p_s of K09, world
  bool has_stuck = false;

  bool slipping = false;            // until |p_s - c| < mu_d d
  Vec3 last_slipped = Vec3::Zero(); // c, a tick ago
  Vec3 trail = Vec3::Zero();        // trails the tip closely over the surface: where it comes from
  Vec3 last_slide = Vec3::Zero();   // from tip to trail, a tick ago

  bool attracted = false; // a magnet pulled

  // Of relief and roughness, a tick ago.
  struct Leaning {
    bool known = false;
    double height = 0; // [m]
    double depth = 0;  // [m]
    Vec3 slope = Vec3::Zero();
  };
  Leaning relief, roughness;
  // Of the lateral stage, a tick ago: Contact::aside and the surface's point that it is from.
  Vec3 aside = Vec3::Zero(), aside_of = Vec3::Zero();
  Vec3 damped = Vec3::Zero(); // of the coupling: last_candidate a tick ago
  bool has_damped = false;
  std::int32_t relief_object = -1, relief_face = -1; // where the next look-up begins
  double sideways = 0;                               // [N], of the stiffness slope

  Vec3 last_raw = Vec3::Zero();    // [N], before limit and fade
  bool has_last_raw = false;       // there is a force that the next one can be compared with
  Vec3 fault_force = Vec3::Zero(); // [N], what is being faded
  double last_stiffness = 0;       // [N/m], of the place where it was
  double since_fault = 0;          // [s]
  bool faulted = false;

  // Of the passivity stage; `applied` is kept by tick().
  Vec3 applied = Vec3::Zero(); // [N], what the last tick gave to the device
  double energy = 0;           // [J], what the surface may still give back
  double brake = 0;            // [N], of its last tick
  Eigen::Matrix<double, 3, kMaxDelay + 1> in_flight =
      Eigen::Matrix<double, 3, kMaxDelay + 1>::Zero(); // [N], forces on their way, a ring
  int newest_in_flight = 0;

  void leaveContact() noexcept {
    in_contact = false;
    proxy.walls.count = 0;
    has_stuck = false;
    slipping = false;
  }
  void reset() noexcept { *this = ContactMemory{}; }
};

// One tick. Inputs are set by tick(); stages fill in the rest, in order.
struct Contact {
  Vec3 tip = Vec3::Zero();      // [m], world
  Vec3 velocity = Vec3::Zero(); // [m/s], backward difference; filtered only by a stage
  double dt = 0;                // [s], since the last finite tip
  Material material;            // the snapshot's base, until a stage knows better

  bool touching = false;
  bool deep = false; // where contact is was found from inside, not by the way in
  bool snap = false; // the contact point runs by itself: no friction, no work of the hand
  bool fault = false;
  bool attracted = false;        // out of contact, pulled by a magnet
  double attraction = 0;         // 1 where the magnet pulls, less where its band fades out
  int samples = 0;               // field evaluations of the contact stage (T-K06d)
  Vec3 normal = Vec3::Zero();    // unit, outward; zero if there is no direction (K05)
  Vec3 candidate = Vec3::Zero(); // frictionless VCP c
  Vec3 vcp = Vec3::Zero();       // p, after friction; the tip if not touching
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
  // Differs from the candidate by the tip's radius and the offset. The tip where nothing is near.
  Vec3 surface = Vec3::Zero();
  std::int32_t object = 0; // that it belongs to, where that matters
  // As the tip moves (pull_back.h); zero unless painted and conservative.
  Vec3 stiffness_gradient = Vec3::Zero(); // [N/m^2]
  Vec3 roughness_gradient = Vec3::Zero(); // over the surface, dimensionless
  // [m], over the surface: relief and roughness are read at surface + aside (lateral_stage.h).
  Vec3 aside = Vec3::Zero();
  double lateral = 0;        // [N/m], of the spring that ties it so; 0 = none, aside is 0
  Vec3 slope = Vec3::Zero(); // of the relief: normal is along n - slope
  double relief_step = 0;    // [m], by which relief moved the VCP this tick, at most
  double stiffness = 0;    // K at the contact [N/m]; of the whole law, where a coupling softens it
  double stick_radius = 0; // [m], how far p may be from c while it sticks; 0 = it does not
  double slip_step = 0;    // [m], how far the VCP let go this tick by a rule of its own
  double known_step = 0;   // [N], a step of the force that the model itself makes this tick
  Vec3 force = Vec3::Zero(); // on the hand [N]
};

} // namespace patina
