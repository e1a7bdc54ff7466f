// The record one servo tick fills in, and what survives it.
#pragma once

#include <cstdint>

#include "core/types.h"
#include "field/field_sampler.h"

namespace patina {

// Survives from tick to tick; owned by the servo thread. reset() = the first tick again.
struct ContactMemory {
  Vec3 last_tip = Vec3::Zero();
  bool has_last_tip = false;
  Vec3 last_normal = Vec3::Zero(); // last valid direction (K05 edge case)
  Vec3 last_vcp = Vec3::Zero();
  bool in_contact = false;
  Vec3 stuck = Vec3::Zero(); // p_s of K09, world
  bool has_stuck = false;
  bool slipping = false; // until |p_s - c| < mu_d d
  Vec3 last_force = Vec3::Zero();
  bool swept = false;         // held at the entry point of a thin part
  double fade = 1;            // 1 = whole force, 0 = faded by a fault
  std::uint64_t bad_tips = 0; // NaN, infinite or out-of-grid tips
  void reset() { *this = ContactMemory{}; }
};

// One tick. Inputs are set by tick(); stages fill in the rest, in order.
struct Contact {
  Vec3 tip = Vec3::Zero();      // [m], world
  Vec3 velocity = Vec3::Zero(); // [m/s], filtered backward difference
  double dt = 0;                // [s]

  bool touching = false;
  bool deep = false;
  bool fault = false;
  Vec3 normal = Vec3::Zero();    // unit, outward
  Vec3 candidate = Vec3::Zero(); // frictionless VCP c
  Vec3 vcp = Vec3::Zero();       // p, after friction
  double depth = 0;              // d [m]
  double stiffness = 0;          // K at the contact [N/m]
  Vec3 force = Vec3::Zero();     // on the hand [N]
};

} // namespace patina
