#include "haptics/link/device_clock.h"

#include "haptics/device/realtime.h"

namespace patina {
namespace {

class SystemClock final : public DeviceClock {
 public:
  double now() const noexcept override { return 1e-9 * static_cast<double>(monotonicNs()); }
  void waitUntil(double seconds) noexcept override {
    sleepUntil(static_cast<std::int64_t>(1e9 * seconds));
  }
};

} // namespace

std::shared_ptr<DeviceClock> systemClock() {
  return std::make_shared<SystemClock>();
}

} // namespace patina
