// What survives a servo tick: one part a stage, declared beside the stage and written by it alone.
#pragma once

#include <limits>
#include <optional>

#include "haptics/contact/proxy.h"
#include "haptics/contact/ray_stage.h"
#include "haptics/stages/coupling_stage.h"
#include "haptics/stages/friction_stage.h"
#include "haptics/stages/lateral_stage.h"
#include "haptics/stages/limit_stage.h"
#include "haptics/stages/magnet_stage.h"
#include "haptics/stages/material_stage.h"
#include "haptics/stages/passivity_stage.h"
#include "haptics/stages/relief_stage.h"
#include "haptics/stages/spring_stage.h"

namespace patina {

// Of tick() itself; stages read it.
struct TipMemory {
  std::optional<Vec3> last;    // the last finite tip
  double gap = 0;              // [s] since then, spent on ticks without a finite tip
  Vec3 applied = Vec3::Zero(); // [N], what the last tick gave to the device
};

// Of the contact stage, whichever it is: contact goes on where an edit changes one for another.
struct ContactPointMemory {
  std::optional<Vec3> c;                                      // [m]; absent out of contact
  double clearance = std::numeric_limits<double>::infinity(); // Contact::clearance
  bool reseat = false; // the surface may be another one than a tick ago
};

// Owned by the servo thread. What several stages need of it is passed through Contact.
struct ContactMemory {
  TipMemory tip;
  ContactPointMemory contact;
  Proxy proxy;
  RayMemory ray;
  LateralMemory lateral;
  TextureMemory relief, roughness, layer;
  FrictionMemory friction;
  VelocityFilterMemory filter;
  StiffnessSlopeMemory stiffness_slope;
  PassivityMemory passivity;
  LimitMemory limit;
  ReliefWalk walk; // of Reliefs::at(), whichever stage asks
  MagnetMemory magnet;
  CouplingMemory coupling;

  // By tick(), where the contact stage has found none.
  void leaveContact() noexcept {
    contact.c.reset();
    proxy.walls.count = 0;
    friction.grip.reset();
  }
  // What the old law measured is not the new one's, and a stage that only the new law has begins
  // afresh. The contact point stays, and is seated on the new surface.
  void changeLaw() noexcept {
    contact.reseat = true;
    contact.clearance = std::numeric_limits<double>::infinity();
    limit.last.reset();
    relief.last.reset();
    roughness.last.reset();
    layer.last.reset();
    lateral.aside.setZero();
    coupling.touched = false;
  }
  void reset() noexcept { *this = ContactMemory{}; } // the first tick again
};

} // namespace patina
