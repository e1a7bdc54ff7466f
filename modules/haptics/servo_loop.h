// The servo thread: device -> stages -> limit -> device (DESIGN section 4).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/ring.h"
#include "core/snapshot_exchange.h"
#include "haptics/device.h"
#include "haptics/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct ServoTiming {
  std::string policy; // "SCHED_FIFO 50, memory locked" or what was refused
  bool realtime = false;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0; // deadlines that passed by more than a period
  // Of the last 8192 ticks at least, exact percentiles [us]:
  double late_p50 = 0, late_p99 = 0, late_p999 = 0, late_max = 0;
  double step_p50_ns = 0, step_p99_ns = 0;
  double rate_hz = 0;
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
  bool running() const;

  // publish: felt at the next tick, never waits. collect: frees snapshots that the servo has left,
  // as publish does too; call it now and then.
  void publish(std::shared_ptr<const HapticSnapshot> snapshot);
  void collect();
  Ring<ToolSample>& samples();  // consumer: one thread; holds 1 s at least
  ServoTiming timing() const;   // any thread
  const Device& device() const; // for info(); keep your own pointer to a MouseDevice

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
