// Whatever a Falcon's line says: finite states, whole frames, and no motor beyond its limit.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "haptics/devices/falcon/falcon_device.h"
#include "haptics/devices/falcon/falcon_frame.h"
#include "haptics/devices/link/link_loop.h"
#include "support/mute_transport.h"

namespace {

using namespace patina;

// Each transfer takes a byte of the input that says how it ends and, of a read, how long it is.
class FuzzedTransport final : public test::MuteTransport {
 public:
  FuzzedTransport(std::span<const std::uint8_t>& input, DeviceClock& clock)
      : input_(input), clock_(clock) {}
  UsbCount write(std::uint8_t, std::span<const std::byte> data, unsigned) noexcept override {
    if (data.size() == kFalconFrame && data[0] == std::byte{'<'}) {
      for (std::size_t motor = 0; motor < 3; ++motor) {
        unsigned value = 0;
        for (std::size_t i = 4; i-- > 0;)
          value = value << 4 | (std::to_integer<unsigned>(data[1 + 4 * motor + i]) - 0x41U);
        const int sent = static_cast<std::int16_t>(value);
        if (value > 0xffffU || std::abs(sent) > kMostMotor) std::abort();
      }
    }
    return {UsbResult::ok, data.size()};
  }
  UsbCount read(std::uint8_t, std::span<std::byte> data, unsigned timeout_ms) noexcept override {
    const int head = take();
    if (head < 0 || head == 0xff) {
      clock_.waitUntil(clock_.now() + 1e-3 * timeout_ms);
      return {UsbResult::timeout, 0};
    }
    if (head == 0xfe) return {UsbResult::stall, 0};
    if (head == 0xfd) return {UsbResult::gone, 0};
    clock_.waitUntil(clock_.now() + ((head & 0x80) != 0 ? 1e-5 : 3e-4));
    const std::size_t size = std::min<std::size_t>(head & 0x7f, data.size());
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::byte>(std::max(take(), 0));
    return {UsbResult::ok, size};
  }

 private:
  int take() {
    if (input_.empty()) return -1;
    const int byte = input_.front();
    input_ = input_.subspan(1);
    return byte;
  }
  std::span<const std::uint8_t>& input_;
  DeviceClock& clock_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> input(data, size);
  const auto clock = std::make_shared<SimulatedClock>();
  const auto notes = std::make_shared<LinkNotes>();
  LinkLoop loop(
      makeFalconLink([&] { return std::make_unique<FuzzedTransport>(input, *clock); }, {}, clock),
      falconGuard(), clock, notes);
  for (int turn = 0; turn < 400 && !input.empty(); ++turn) {
    const DeviceState& state = loop.step({Vec3(1, -2, 30), clock->now()});
    if (!state.position.allFinite() || !std::isfinite(state.age)) std::abort();
    if (state.status == DeviceStatus::ok && state.position.norm() > 1) std::abort();
    clock->waitUntil(clock->now() + 1e-3);
  }
  return 0;
}
