// A servo loop that is opened again and again: publish, aim, drain. One thread, but publish().
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "haptics/devices/tip_target.h"
#include "haptics/servo/servo_loop.h"

namespace patina {

class TipServo {
 public:
  // Starts a new loop with this device; it feels what was published last. setTarget() moves the
  // target, where the device has one. The old loop, if any, stops first. rate in 100 .. 10000 Hz.
  void open(std::unique_ptr<Device> device, std::shared_ptr<TipTarget> target, double rate = 1000);
  // Any thread: contact goes on, with the next tick by the new law. Waits at most for another
  // publisher, never for the servo.
  void publish(std::shared_ptr<const HapticSnapshot> snapshot);
  void close(); // what the loop has left is still there for drain()
  bool running() const { return loop_ != nullptr; }

  void setTarget(const Vec3& target); // any one thread at a time; never waits
  // The same of a place that a pointer was at, at time t; see TipTarget.
  void passTarget(const Vec3& target, double t);
  void leapTarget(const Vec3& target, double t);
  bool passed() const; // nothing of that is left
  // Since the last call, oldest first. t counts from the first loop's start and increases over all
  // loops of this host.
  std::vector<ToolSample> drain();
  ServoTiming timing() const;
  std::size_t dropped() const; // samples that nobody drained in time, of all loops

 private:
  void empty(std::vector<ToolSample>& into);

  std::mutex publishers_; // of newest_, and of loop_ where another thread may see it
  std::shared_ptr<const HapticSnapshot> newest_;
  std::unique_ptr<ServoLoop> loop_; // set by the one thread alone
  std::shared_ptr<TipTarget> target_;
  std::vector<ToolSample> left_;
  std::chrono::steady_clock::time_point began_;
  bool began_once_ = false;
  double offset_ = 0, last_t_ = 0; // [s]
  std::size_t dropped_before_ = 0;
};

} // namespace patina
