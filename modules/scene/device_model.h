// Model of a force-feedback device for stability limits (MATH 2.1, 2.2).
#pragma once

namespace patina {

inline constexpr int kMaxDelay = 20; // samples

struct DeviceModel {
  double mass = 0.1;       // m [kg]
  double damping = 0.5;    // b [N s/m], viscous
  double coulomb = 0;      // fc [N], dry friction
  double encoder_step = 0; // Delta [m], position resolution; 0 = exact
  double rate = 1000;      // 1/T [Hz]
  int delay = 0; // n <= kMaxDelay, whole samples from reading the tip to applying the force
  bool operator==(const DeviceModel&) const = default;
};

// Stabilisers in the servo's force path (F13; Adams & Hannaford 1999; Hannaford & Ryu 2002).
struct Stabilisers {
  bool coupling = false;  // virtual coupling, damped along the vector from contact point to tip
  bool passivity = false; // passivity controller on the generated energy, as a watchdog
  bool operator==(const Stabilisers&) const = default;
};

} // namespace patina
