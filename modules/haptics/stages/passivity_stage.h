// Passivity controller: damps where the surface has given more energy than it may (MATH 2.3).
#pragma once

#include "haptics/stages/stage.h"
#include "scene/device_model.h"

namespace patina {

// The ledger E -= F.dx is exact, because F is the force that the device held while the tip moved by
// dx: after the limit, and `delay` ticks old. Where E < 0, F -= alpha v with alpha = -E / (T v^2)
// pays the debt back within a tick, but never more than `most`. What the device's own damping takes
// is not credited: that would only bring the loop to the edge, where it rings forever (F13).
//
// What E may be at most is what the surface can rightly return: 1/2 k s^2 of the spring in contact,
// plus `reserve` (the energy of a magnet's band). Everything beyond has been dissipated and is
// forgotten, so that an hour of rubbing is no credit for a buzz. It starts there. A debt is never
// forgotten: what is left of it where contact ends is taken from the free tip (waiting for the next
// contact, K = 1e5 N/m rings at 0.8 m/s instead of 0.02). Below `kRounding` a debt is rounding.
struct PassivitySpec {
  double most = 0;    // alpha [N s/m]
  double reserve = 0; // [J]
  int delay = 0;      // samples, at most kMaxDelay
};

struct PassivityMemory {
  double energy = 0; // [J], what the surface may still give back
  double brake = 0;  // [N], of the last tick
  Eigen::Matrix<double, 3, kMaxDelay + 1> in_flight =
      Eigen::Matrix<double, 3, kMaxDelay + 1>::Zero(); // [N], forces on their way, a ring
  int newest = 0;                                      // of them
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
