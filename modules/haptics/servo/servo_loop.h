// The servo thread: device -> stages -> limit -> device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/ring.h"
#include "core/snapshot_exchange.h"
#include "haptics/devices/device.h"
#include "haptics/servo/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct ServoTiming {
  std::string policy; // "SCHED_FIFO 50, memory locked" or what was refused
  bool realtime = false;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0; // deadlines that passed by more than a period
  double late_p99 = 0;      // [us], exact, of the last 8192 ticks at least
  double rate_hz = 0;
  // Calibrating or away: the loop holds, without force. Any failure: it has ended, without force.
  DeviceStatus device = DeviceStatus::ok;
};

// All of it belongs to one thread (the window's), except what says otherwise.
class ServoLoop {
 public:
  // Does not start. rate in 100 .. 10000 Hz.
  ServoLoop(std::unique_ptr<Device> device, double rate_hz = 1000);
  ~ServoLoop(); // stops
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  void start();
  void stop();
  bool running() const; // started and not stopped, even if the device has failed

  // publish: felt at the next tick, never waits. collect: frees snapshots that the servo has left,
  // as publish does too; call it now and then.
  void publish(std::shared_ptr<const HapticSnapshot> snapshot);
  void collect();
  Ring<ToolSample>& samples(); // consumer: one thread; holds 16384, 1 s at least
  ServoTiming timing() const;  // any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
