// The hand's side of the loop.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

struct DeviceState {
  Vec3 tip = Vec3::Zero(); // [m], world
  bool button = false;
  bool finished = false; // a replay came to its end
};

struct DeviceInfo {
  std::string name;
  double max_force = 0;     // [N]; 0 = cannot render force
  double max_stiffness = 0; // [N/m]; 0 = not stated
  std::string note;
};

class Device {
 public:
  virtual ~Device() = default;
  // Servo thread: sends the force and reads the state dt later. No lock, allocation or throw.
  virtual DeviceState exchange(const Vec3& force, double dt) noexcept = 0;
  virtual DeviceInfo info() const = 0;
};

// One exact step of m x'' + b x' = F with F held over dt (MATH 2.1): x += c v + d F, v = a v + e F.
// b = 0 and b dt/m -> 0 keep all their digits.
struct HeldForceStep {
  double a, c, d, e;
};
HeldForceStep heldForceStep(double mass, double damping, double dt) noexcept;

// A point mass with viscous damping in a hand that pushes with a given force, stepped exactly for a
// force held over dt (F2). Throws std::invalid_argument unless mass > 0 and
// damping >= 0.
struct SimulatedDeviceSpec {
  double mass = 0.1;    // [kg]
  double damping = 0.5; // [N s/m]
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 hand_force = Vec3::Zero();
};
std::unique_ptr<Device> makeSimulatedDevice(const SimulatedDeviceSpec& spec);

// Plays tips one a tick, then holds the last with finished = true.
std::unique_ptr<Device> makeReplayDevice(std::vector<Vec3> tips);

// The mouse: the window sets a target from its thread, the servo glides to it at no more than
// max_speed, so that a jump of the pointer is not a jump of the tip.
class MouseDevice : public Device {
 public:
  virtual void setTarget(const Vec3& world) noexcept = 0; // UI thread, wait-free
};
std::unique_ptr<MouseDevice> makeMouseDevice(const Vec3& start, double max_speed = 1.0);

} // namespace patina
