// Result of one servo tick for the window, recorders and brush.
#pragma once

#include <cstdint>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct ToolSample {
  double t = 0;              // [s] since the loop began
  Vec3 tip = Vec3::Zero();   // [m], world
  Vec3 force = Vec3::Zero(); // [N] on the hand
  Vec3 vcp = Vec3::Zero();   // virtual contact point [m]; the tip if there is no contact
  // Nearest point of the original surface, for display of contact and for edits (K12); the tip if
  // there is neither contact nor attraction.
  Vec3 surface = Vec3::Zero();
  Vec3 normal = Vec3::Zero(); // unit, outward; zero without contact
  double depth = 0;           // |vcp - tip| along the normal [m]
  bool contact = false;
  bool attracted = false;   // out of contact, pulled by a magnet
  bool deep = false;        // found from the interior, not along the way in
  bool fault = false;       // a jump faded the force to zero (F13)
  bool relocating = false;  // the contact point moves by itself: no friction, no work of the hand
  std::uint8_t buttons = 0; // bit i: the device's button i is down
  std::uint8_t constraint_count = 0; // 1 on a face, 2 at an edge, 3 in a corner
  std::uint32_t step_ns = 0;         // time inside tick()
  std::uint32_t late_ns = 0;         // wake-up latency after the deadline
};

} // namespace patina
