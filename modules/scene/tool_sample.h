// What the servo thread says about one tick; drained by the window, recorders and (later) the
// brush.
#pragma once

#include <cstdint>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct ToolSample {
  double t = 0;              // [s] since the loop began
  Vec3 tip = Vec3::Zero();   // [m], world
  Vec3 force = Vec3::Zero(); // [N] on the hand
  Vec3 vcp = Vec3::Zero();   // virtual contact point [m]; the tip if there is no contact
  // The nearest point of the original surface, where contact is seen and an edit acts (K12); the
  // tip if there is neither contact nor pull.
  Vec3 surface = Vec3::Zero();
  Vec3 normal = Vec3::Zero(); // unit, outward; zero if there is no contact
  double depth = 0;           // |vcp - tip| along the normal [m]
  std::int32_t face = -1;     // nearest face of `surface`
  bool contact = false;
  bool attracted = false; // out of contact, pulled by a magnet
  bool deep = false;      // where contact is was found from inside, not by the way in
  bool fault = false;     // a jump faded the force to zero (F13)
  bool snap = false;      // the contact point ran by itself: no friction, no work of the hand
  std::uint8_t buttons = 0; // of the device; bit i: button i is down
  std::uint8_t held = 0;  // how many walls hold the contact point: 1 a face, 2 an edge, 3 a corner
  std::uint32_t step_ns = 0; // time inside tick()
  std::uint32_t late_ns = 0; // wake-up after its deadline
};

} // namespace patina
