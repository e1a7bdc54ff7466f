// The time that a driver waits in: the system's, or one that a test or an emulator moves.
#pragma once

#include <memory>

namespace patina {

class DeviceClock {
 public:
  virtual ~DeviceClock() = default;
  virtual double now() const noexcept = 0;             // [s], since any moment
  virtual void waitUntil(double seconds) noexcept = 0; // returns at once where it has passed
};

std::shared_ptr<DeviceClock> systemClock(); // monotonic

// Stands still but where somebody waits in it: hours pass in no time, each run alike. One thread's.
class SimulatedClock final : public DeviceClock {
 public:
  double now() const noexcept override { return now_; }
  void waitUntil(double seconds) noexcept override {
    if (seconds > now_) now_ = seconds;
  }

 private:
  double now_ = 0;
};

} // namespace patina
