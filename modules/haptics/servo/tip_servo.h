// A servo loop that can be reopened with other devices. One thread, except publish() and
// takePaintSamples().
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "haptics/device/tip_target.h"
#include "haptics/servo/servo_loop.h"

namespace patina {

class TipServo {
 public:
  // Starts a new loop with this device and the last published law, after stopping the old one.
  // `target`: the device's target for setTarget(), or null. rate in 100 .. 10000 Hz.
  void open(std::unique_ptr<Device> device, std::shared_ptr<TipTarget> target, double rate = 1000);
  // Any thread: the next tick uses the new law in contact. May wait for another publisher only.
  void publish(std::shared_ptr<const HapticSnapshot> snapshot);
  void close(); // drain() still returns the remaining samples
  bool running() const { return loop_ != nullptr; }

  void setTarget(const Vec3& target); // one thread at a time; never waits
  // Waypoints of a pointer at time t; see TipTarget.
  void addWaypoint(const Vec3& target, double t);
  void jumpTarget(const Vec3& target, double t);
  bool passed() const; // no waypoint is pending
  // Returns the samples since the last call, oldest first. t counts from the first loop's start and
  // increases over all loops of this object.
  std::vector<ToolSample> drain();
  // Appends the samples since the last call, with the same times. For one thread that paints, which
  // may be another one; waits at most for publish().
  void takePaintSamples(std::vector<ToolSample>& into);
  ServoTiming timing() const;
  std::size_t dropped() const; // samples lost because drain() came too late, in all loops

 private:
  void empty(std::vector<ToolSample>& into);
  void takePaintSamplesLocked(std::vector<ToolSample>& into);

  std::mutex publishers_; // guards newest_, and loop_ for publishers
  std::shared_ptr<const HapticSnapshot> newest_;
  std::unique_ptr<ServoLoop> loop_; // set by the owning thread only
  std::shared_ptr<TipTarget> target_;
  std::vector<ToolSample> left_, paint_left_;
  std::chrono::steady_clock::time_point began_;
  bool began_once_ = false;
  double offset_ = 0, last_t_ = 0; // [s]
  std::size_t dropped_before_ = 0;
};

} // namespace patina
