// Stage that is always present: force limit and jump fault (F13, MATH 2.8).
#pragma once

#include <optional>

#include "haptics/law/stage.h"

namespace patina {

inline constexpr double kHandSpeed = 2;         // [m/s], in a workspace of kHandWorkspace
inline constexpr double kHandWorkspace = 0.2;   // [m]; larger models use a scaled hand motion
inline constexpr double kFaultFadeTime = 0.05;  // [s]
inline constexpr double kFaultReturnTime = 0.2; // [s]

struct LimitSpec {
  double force_limit = 3.3;      // limit of the magnitude; the vector is scaled [N]
  double pull = 0;               // stiffness of a magnet [N/m]
  double damping = 0;            // B, the largest in the scene [N s/m]
  double max_speed = kHandSpeed; // v_max [m/s]
};

struct LimitMemory {
  struct Raw {
    Vec3 force;       // before limit and fade [N]
    double stiffness; // stiffness at the contact [N/m]
  };
  std::optional<Raw> last; // last tick; absent if there is none to compare with
  struct Fault {
    Vec3 force;   // force that fades out [N]
    double since; // time since the fault [s]
  };
  std::optional<Fault> fault;
  bool jumped = false; // jump in the last tick
};

// Scales the force to a magnitude of at most `limit`.
Vec3 scaledTo(const Vec3& force, double limit) noexcept;

// A jump fault is a change of the unlimited force within a tick by more than 2 v_max (K T + B),
// plus expected jumps: K times the slip's release, the magnet's step at its range, and (K + B/T)
// times the contact point's movement by relief. K is the larger of this and the last tick's
// stiffness, B the scene's largest damping. After a fault the last force fades to zero over
// kFaultFadeTime, and the new force fades in over kFaultReturnTime, wherever the tip is. A v_max
// above kHandSpeed raises the threshold up to the force limit only, or a large model of ordinary
// stiffness would never fault. T is the time since the last tick, clamped to 0.1 .. 50 ms, so that
// a missed tick is no fault. The first tick is never a fault. The force rate is never limited.
class LimitStage final : public ForceStage {
 public:
  explicit LimitStage(const LimitSpec& spec) : spec_(spec) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  bool jumped(const Contact& contact, const LimitMemory& memory) const noexcept;

  LimitSpec spec_;
};

} // namespace patina
