// An emulated Falcon, its driver and guard, stepped in simulated time.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_device.h"
#include "haptics/link/link_loop.h"

namespace patina::test {

struct SentFrame {
  double t = 0;
  std::array<int, 3> motors{};
  bool force() const { return motors != std::array<int, 3>{}; }
};

inline std::vector<std::byte> madeUpFirmware(std::size_t size = 8000) {
  std::vector<std::byte> image(size);
  for (std::size_t i = 0; i < size; ++i)
    image[i] = static_cast<std::byte>((i * 37 + i / 251) & 255);
  return image;
}

class FalconRig {
 public:
  explicit FalconRig(const FalconEmulatorSpec& spec = {}, FalconFirmwareSource firmware = {},
                     const GuardSpec& guard = falconGuard())
      : clock(std::make_shared<SimulatedClock>()), notes(std::make_shared<LinkStatistics>()),
        bench(spec, clock),
        loop(makeFalconLink([this] { return bench.plug(); }, std::move(firmware), clock), guard,
             clock, notes) {
    bench.on_frame = [this](double t, const std::array<int, 3>& motors) {
      sent.push_back({t, motors});
    };
  }

  // Runs one tick of the servo: a new command, unless it has stopped, and the rest of the
  // millisecond.
  const DeviceState& tick(const Vec3& force, bool servo_runs = true) {
    due_ += 1e-3;
    if (due_ < clock->now()) due_ = clock->now();
    clock->waitUntil(due_);
    if (servo_runs) command = {force, clock->now()};
    return loop.step(command);
  }
  // Waits until the device is ok; returns false if that takes longer than `seconds`.
  bool waitUntilOk(double seconds, const Vec3& force = Vec3::Zero()) {
    const double until = clock->now() + seconds;
    while (clock->now() < until)
      if (tick(force).status == DeviceStatus::ok) return true;
    return false;
  }
  // Waits until the guard lets all of the force through.
  bool waitUntilFelt(const Vec3& force, double seconds = 3) {
    const double until = clock->now() + seconds;
    while (clock->now() < until) {
      tick(force);
      if (notes->gain >= 1) return true;
    }
    return false;
  }

  std::shared_ptr<SimulatedClock> clock;
  std::shared_ptr<LinkStatistics> notes;
  std::vector<SentFrame> sent;
  FalconEmulator bench;
  LinkLoop loop;
  LinkCommand command;

 private:
  double due_ = 0;
};

} // namespace patina::test
