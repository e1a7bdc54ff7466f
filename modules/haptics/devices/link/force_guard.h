// What stands between every real device and the forces that are asked of it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "haptics/devices/device.h"

namespace patina {

// Why no force is sent; the first that holds, in this order.
enum class Hold : std::uint8_t {
  none,
  device,  // its own status says so
  servo,   // no command for longer than GuardSpec::oldest_command
  window,  // nobody has looked for longer than GuardSpec::oldest_look
  command, // what is asked is no number
  let_go,  // the dead man's button is up
};
// "the servo is late" ...: after "no force: ".
const char* text(Hold hold) noexcept;

// Windings that warm with the square of the force and cool with one time constant. Heat is 1 where
// `continuous` is held for ever.
struct MotorHeat {
  double continuous = std::numeric_limits<double>::infinity(); // [N]
  double time_constant = 60;                                   // [s]
};

struct GuardSpec {
  double max_force = std::numeric_limits<double>::infinity(); // [N], of the magnitude
  std::optional<Box3> workspace{};                            // [m]: no force pushes further out
  MotorHeat motors{};
  Vec3 weight = Vec3::Zero();   // [N], of the handle: borne, part of the force
  double oldest_command = 3e-3; // [s]
  double oldest_look = 0.5;     // [s]; the window looks 30 times a second
  double ramp = 0.25;           // [s], from no force to all of it
};

inline constexpr double kWorkspaceEdge = 2e-3; // [m], over which what pushes out is taken away

// A hold takes the force away at once; when it ends the force comes back evenly over `ramp`. Motors
// that near the heat they stand are given less, evenly, down to what they stand for ever: their
// heat does not pass 1.
class ForceGuard {
 public:
  struct Asked {
    Vec3 force = Vec3::Zero(); // [N], device frame
    double command_age = 0;    // [s]
    double look_age = 0;       // [s]
    bool needs_button = false; // no force unless a person holds a button of the device
  };
  // Throws std::invalid_argument unless limits, ramp and times are above 0, and where motors warm
  // and nothing bounds the force.
  explicit ForceGuard(const GuardSpec& spec);
  // What may be sent for the next dt [s], after this reading of the device. Finite, whatever is
  // asked or read.
  Vec3 pass(const Asked& asked, const DeviceState& reading, double dt) noexcept;
  Hold hold() const noexcept { return hold_; }
  double gain() const noexcept { return gain_; } // of the force, 0 to 1
  double heat() const noexcept { return heat_; } // of the motors

 private:
  Hold holdFor(const Asked& asked, const DeviceState& reading) const noexcept;
  double mostNow() const noexcept;

  GuardSpec spec_;
  Hold hold_ = Hold::device;
  double gain_ = 0;
  double heat_ = 0;
};

} // namespace patina
