// The stage that is never left out: the magnitude limit and the jump fault (F13, MATH 2.8).
#pragma once

#include <optional>

#include "haptics/stages/stage.h"

namespace patina {

inline constexpr double kHandSpeed = 2;         // [m/s], in a workspace of
inline constexpr double kHandWorkspace = 0.2;   // [m]; a larger model is felt through a scaled hand
inline constexpr double kFaultFadeTime = 0.05;  // [s]
inline constexpr double kFaultReturnTime = 0.2; // [s]

struct LimitSpec {
  double force_limit = 3.3;      // [N], of the magnitude: the vector is scaled
  double pull = 0;               // [N/m], of a magnet
  double damping = 0;            // B [N s/m], of the most damped one
  double max_speed = kHandSpeed; // v_max [m/s]
};

struct LimitMemory {
  struct Raw {
    Vec3 force;       // [N], before limit and fade
    double stiffness; // [N/m], of the place where it was
  };
  std::optional<Raw> last; // a tick ago; absent: nothing that the next one can be compared with
  struct Fault {
    Vec3 force;   // [N], what is being faded
    double since; // [s]
  };
  std::optional<Fault> fault;
  bool jumped = false; // a tick ago
};

// The force scaled so that its magnitude is at most `limit`.
Vec3 scaledTo(const Vec3& force, double limit) noexcept;

// Jump fault: where the force (before the limit) changes within a tick by more than
// 2 v_max (K T + B), plus K times what the VCP let go as a slip began, the step of a magnet where
// its band ends and what relief moved the VCP by (K + B/T). K is the place's own, now or a tick
// ago, and B the scene's greatest. Then the last force fades to zero over kFaultFadeTime, and what
// is felt from there on fades in over kFaultReturnTime, wherever the tip is: a solid is never left
// without force. A v_max above kHandSpeed raises the threshold up to the force limit and no
// further: a large model of ordinary stiffness would never fault. T is the time since the last
// tick, taken between 0.1 and 50 ms, so that a missed tick is no fault. The first tick is none
// either. The rate of the force is never limited.
class LimitStage final : public ForceStage {
 public:
  explicit LimitStage(const LimitSpec& spec) : spec_(spec) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool jumped(const Contact& contact, const LimitMemory& memory) const noexcept;

  LimitSpec spec_;
};

} // namespace patina
