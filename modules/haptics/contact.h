// The record one servo tick fills in, and what survives it.
#pragma once

#include <cstdint>
#include <limits>

#include "core/types.h"

namespace patina {

// How the virtual contact point (VCP) was found this tick.
enum class ContactMode : std::uint8_t {
  ray,    // K06: first intersection of the ray along the direction with the surface
  held,   // tracked on the near side of a part that the tip has passed through or half through
  newton, // the ray found no surface (F9): one Newton step
};

// Survives from tick to tick; owned by the servo thread. reset() = the first tick again.
struct ContactMemory {
  Vec3 last_tip = Vec3::Zero();
  bool has_last_tip = false;
  Vec3 velocity = Vec3::Zero();    // [m/s], filtered
  double gap = 0;                  // [s] since last_tip, spent on ticks without a finite tip
  std::uint64_t bad_tips = 0;      // NaN or infinite
  std::uint64_t outside_ticks = 0; // tip out of the field's grid

  bool in_contact = false;
  ContactMode mode = ContactMode::ray;
  Vec3 last_normal = Vec3::Zero(); // last valid direction (K05 edge case)
  Vec3 last_candidate = Vec3::Zero();
  // phi - iso at last_tip [voxels] while out of contact: the surface cannot be crossed by a step
  // shorter than this and its successor together. Infinite = unknown, do not look.
  double clearance = std::numeric_limits<double>::infinity();
  Vec3 handover = Vec3::Zero(); // [m], added to the VCP after a change of mode, decaying
  bool has_handover = false;

  Vec3 stuck = Vec3::Zero(); // p_s of K09, world
  bool has_stuck = false;
  bool slipping = false;          // until |p_s - c| < mu_d d
  Vec3 trail = Vec3::Zero();      // trails the tip closely over the surface: where it comes from
  Vec3 last_slide = Vec3::Zero(); // from tip to trail, a tick ago

  Vec3 last_raw = Vec3::Zero();    // [N], before limit and fade
  Vec3 fault_force = Vec3::Zero(); // [N], what is being faded
  double fade = 1;                 // 1 = whole force, 0 = faded by a fault
  bool faulted = false;

  bool held() const noexcept { return in_contact && mode == ContactMode::held; }
  void leaveContact() noexcept {
    in_contact = false;
    mode = ContactMode::ray;
    has_handover = false;
    has_stuck = false;
    slipping = false;
  }
  void reset() noexcept { *this = ContactMemory{}; }
};

// One tick. Inputs are set by tick(); stages fill in the rest, in order.
struct Contact {
  Vec3 tip = Vec3::Zero();      // [m], world
  Vec3 velocity = Vec3::Zero(); // [m/s], filtered backward difference
  double dt = 0;                // [s], since the last finite tip

  bool touching = false;
  bool deep = false; // deeper than the band: the direction is the coarse nodes'
  bool held = false; // see ContactMode
  bool fault = false;
  bool approximate = false;      // see ContactMode::newton
  int samples = 0;               // field evaluations of the contact stage (T-K06d)
  Vec3 normal = Vec3::Zero();    // unit, outward; zero if there is no direction (K05)
  Vec3 candidate = Vec3::Zero(); // frictionless VCP c
  Vec3 vcp = Vec3::Zero();       // p, after friction; the tip if not touching
  double depth = 0;              // d = (c - x).n [m]
  double stiffness = 0;          // K at the contact [N/m]
  double stick_radius = 0;       // [m], how far p may be from c while it sticks; 0 = it does not
  double slip_step = 0;          // [m], how far the VCP let go this tick as slip began
  Vec3 force = Vec3::Zero();     // on the hand [N]
};

} // namespace patina
