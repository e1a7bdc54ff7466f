// Clock that a driver waits on: the system's, or one that a test or an emulator advances.
#pragma once

#include <memory>

namespace patina {

class DeviceClock {
 public:
  virtual ~DeviceClock() = default;
  virtual double now() const noexcept = 0;             // [s] since an arbitrary moment
  virtual void waitUntil(double seconds) noexcept = 0; // returns at once if the time has passed
};

std::shared_ptr<DeviceClock> systemClock(); // monotonic

// Advances only when its user waits, so that each run is fast and identical. One thread only.
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
