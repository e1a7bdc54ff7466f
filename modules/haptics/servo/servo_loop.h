// Servo thread: device -> stages -> limit -> device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/ring.h"
#include "core/snapshot_exchange.h"
#include "haptics/device/device.h"
#include "haptics/law/snapshot.h"
#include "scene/tool_sample.h"

namespace patina {

struct ServoTiming {
  std::string policy; // "SCHED_FIFO 50, memory locked", or the refusal
  bool realtime = false;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0; // deadlines missed by more than a period
  double late_p99 = 0; // 99th percentile of wake-up latency, at least of the last 8192 ticks [us]
  double rate_hz = 0;
  // Calibrating or reconnecting: the loop continues without force. A failure has ended it.
  DeviceStatus device = DeviceStatus::ok;
};

// Single-threaded (the window's thread), except as noted.
class ServoLoop {
 public:
  // Does not start the thread. rate in 100 .. 10000 Hz.
  ServoLoop(std::unique_ptr<Device> device, double rate_hz = 1000);
  ~ServoLoop(); // stops the thread
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  void start();
  void stop();
  bool running() const; // true from start() to stop(), even after a device failure

  // publish(): takes effect at the next tick; never waits. collect(): frees snapshots that the
  // servo no longer uses, as publish() does too; call it regularly.
  void publish(std::shared_ptr<const HapticSnapshot> snapshot);
  void collect();
  Ring<ToolSample>& samples();       // one consumer thread; holds 16384 samples, at least 1 s
  Ring<ToolSample>& paint_samples(); // the same samples for the thread that paints; holds 4096
  ServoTiming timing() const;        // any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
