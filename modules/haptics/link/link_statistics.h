// Counters and status of a device thread, and requests to it.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/timing_window.h"
#include "haptics/device/device.h"
#include "haptics/link/force_guard.h"

namespace patina {

// Any thread, except as noted.
struct LinkStatistics {
  explicit LinkStatistics(std::size_t window = 8192) : round_trip(window) {}

  std::atomic<DeviceStatus> status{DeviceStatus::reconnecting};
  std::atomic<ForceInhibit> inhibit{ForceInhibit::device};
  std::atomic<double> gain{0}, heat{0};        // force factor; heat of the motors
  std::atomic<std::uint64_t> round_trips{0};   // answered round trips
  std::atomic<std::uint64_t> faults{0};        // unanswered or faulty ones
  std::atomic<std::uint64_t> overruns{0};      // round trips without a new command
  std::atomic<std::uint64_t> connect_count{0}; // number of times the device started to respond
  std::atomic<double> heartbeat_at{-1};        // [s], device clock; below 0: no heartbeat yet
  std::atomic<bool> requires_deadman{false};   // force only while the dead-man's button is held
  TimingWindow round_trip; // durations of answered round trips [ns]; written by the device thread

  std::string cause() const {
    const std::lock_guard lock(text_);
    return cause_;
  }
  void setCause(const std::string& cause) { // device thread, while no force is sent
    const std::lock_guard lock(text_);
    cause_ = cause;
  }

 private:
  mutable std::mutex text_;
  std::string cause_; // reason why the device does not respond
};

// Reason for missing or reduced force, one line; empty at full force.
std::string inhibitText(const LinkStatistics& notes);

} // namespace patina
