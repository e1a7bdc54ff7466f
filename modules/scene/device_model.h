// What a force-feedback device is, as far as it decides how stiff a surface can be (MATH 2.1, 2.2).
#pragma once

namespace patina {

inline constexpr int kMaxDelay = 20; // samples

struct DeviceModel {
  double mass = 0.1;       // m [kg]
  double damping = 0.5;    // b [N s/m], viscous
  double coulomb = 0;      // fc [N], dry friction
  double encoder_step = 0; // Delta [m], resolution of position; 0 = exact
  double rate = 1000;      // 1/T [Hz]
  int delay = 0; // n <= kMaxDelay, whole samples between reading the tip and applying the force
  bool operator==(const DeviceModel&) const = default;
};

// Which safety nets the servo's force goes through (F13, MATH 2.3).
struct Stabilisers {
  bool coupling = false;  // virtual coupling with damping on the VCP-tip vector
  bool passivity = false; // passivity controller on the uncredited energy, as a watchdog
  bool operator==(const Stabilisers&) const = default;
};

} // namespace patina
