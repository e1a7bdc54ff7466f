// State that survives a servo tick: one part per stage, declared next to it and written by it.
#pragma once

#include <limits>
#include <optional>

#include "haptics/contact/proxy.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/friction_stage.h"
#include "haptics/law/lateral_stage.h"
#include "haptics/law/limit_stage.h"
#include "haptics/law/magnet_stage.h"
#include "haptics/law/material_stage.h"
#include "haptics/law/passivity_stage.h"
#include "haptics/law/ray_stage.h"
#include "haptics/law/relief_stage.h"
#include "haptics/law/spring_stage.h"

namespace patina {

// Written by tick() and read by the stages.
struct TipMemory {
  std::optional<Vec3> last;    // last finite tip
  double gap = 0;              // time since then, spent on ticks without a finite tip [s]
  Vec3 applied = Vec3::Zero(); // force of the last tick on the device [N]
};

// State of the contact stage, of either kind, so that contact continues if an edit exchanges it.
struct ContactPointMemory {
  std::optional<Vec3> c;                                      // [m]; absent without contact
  double clearance = std::numeric_limits<double>::infinity(); // Contact::clearance
  bool reproject = false; // the surface may have changed since the last tick
};

// Servo thread only. Values that several stages need are passed through Contact.
struct ContactMemory {
  TipMemory tip;
  ContactPointMemory contact;
  Proxy proxy;
  RayMemory ray;
  LateralMemory lateral;
  TextureMemory relief, roughness, layer;
  FrictionMemory friction;
  VelocityFilterMemory filter;
  StiffnessSlopeMemory stiffness_gradient;
  PassivityMemory passivity;
  LimitMemory limit;
  ReliefWalk walk; // walk of Reliefs::at(), shared by the stages
  MagnetMemory magnet;
  CouplingMemory coupling;

  // Called by tick() if the contact stage found no contact.
  void leaveContact() noexcept {
    contact.c.reset();
    proxy.walls.count = 0;
    friction.stick.reset();
  }
  // Forgets the old law's measurements and resets stages that only the new law has. The contact
  // point stays and is reprojected onto the new surface.
  void changeLaw() noexcept {
    contact.reproject = true;
    contact.clearance = std::numeric_limits<double>::infinity();
    limit.last.reset();
    relief.last.reset();
    roughness.last.reset();
    layer.last.reset();
    lateral.lateral_offset.setZero();
    coupling.touched = false;
  }
  void reset() noexcept { *this = ContactMemory{}; } // state before the first tick
};

} // namespace patina
