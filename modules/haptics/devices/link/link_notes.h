// What a device's own thread tells whoever shows it, and what it is told.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/timing_window.h"
#include "haptics/devices/device.h"
#include "haptics/devices/link/force_guard.h"

namespace patina {

// Any thread, but where it says otherwise.
struct LinkNotes {
  explicit LinkNotes(std::size_t round_trips = 8192) : round_trip(round_trips) {}

  std::atomic<DeviceStatus> status{DeviceStatus::away};
  std::atomic<Hold> hold{Hold::device};
  std::atomic<double> gain{0}, heat{0};   // of the force; of the motors
  std::atomic<std::uint64_t> turns{0};    // round trips that were answered
  std::atomic<std::uint64_t> faults{0};   // and those that were not, or badly
  std::atomic<std::uint64_t> overruns{0}; // turns that began without a new command
  std::atomic<std::uint64_t> openings{0}; // times that it began to answer
  std::atomic<double> looked_at{-1};      // [s], of the device's clock; below 0: nobody looks
  std::atomic<bool> needs_button{false};  // the dead man's: force while one is held, no longer
  TimingWindow round_trip; // [ns], of the last that were answered; the device's thread writes

  std::string cause() const {
    const std::lock_guard lock(text_);
    return cause_;
  }
  void setCause(const std::string& cause) { // the device's thread, while no force is sent
    const std::lock_guard lock(text_);
    cause_ = cause;
  }

 private:
  mutable std::mutex text_;
  std::string cause_; // what keeps it from answering
};

// Why the hand is given no force, or not all of it yet: one line; empty where nothing is held back.
std::string heldBack(const LinkNotes& notes);

} // namespace patina
