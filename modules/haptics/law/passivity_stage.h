// Passivity controller (Hannaford & Ryu 2002): damps excess generated energy (MATH 2.3).
#pragma once

#include "haptics/law/stage.h"
#include "scene/device_model.h"

namespace patina {

// The observer E -= F.dx is exact, because F is the force that the device applied while the tip
// moved by dx: after the limit and `delay` ticks old. If E < 0, F -= alpha v with alpha = -E / (T
// v^2) dissipates the deficit within a tick, with alpha limited to `max_damping`. Damping of the
// device is not credited: the loop would then stay at its stability limit and ring for ever (F13).
//
// E is capped at the energy that the surface may return: 1/2 k s^2 of the spring in contact plus
// `allowed_energy` (the magnet's). Excess has been dissipated and gives no credit, so that an hour
// of rubbing does not permit a later oscillation. E starts at the cap. A deficit is never
// cancelled; the rest is taken from the free tip after contact (if it waited for the next contact,
// K = 1e5 N/m would ring at 0.8 m/s instead of 0.02). A deficit below `kRounding` is rounding.
struct PassivitySpec {
  double max_damping = 0;    // largest alpha [N s/m]
  double allowed_energy = 0; // energy that a magnet may return [J]
  int delay = 0;             // [samples], at most kMaxDelay
};

struct PassivityMemory {
  double energy = 0;           // energy that the surface may still return [J]
  double controller_force = 0; // controller force of the last tick [N]
  Eigen::Matrix<double, 3, kMaxDelay + 1> in_flight =
      Eigen::Matrix<double, 3, kMaxDelay + 1>::Zero(); // ring of forces not applied yet [N]
  int newest = 0;                                      // column of the newest force
};

class PassivityStage final : public ForceStage {
 public:
  static constexpr double kRounding = 1e-12; // [J]
  explicit PassivityStage(const PassivitySpec& spec) : spec_(spec) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  PassivitySpec spec_;
};

} // namespace patina
