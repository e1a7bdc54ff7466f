// Any bytes from a Falcon give finite states, whole frames, and no motor beyond its limit.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "haptics/falcon/falcon_device.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/link/link_loop.h"
#include "support/mute_transport.h"

namespace {

using namespace patina;

// Each read takes an input byte that sets its result and its length; some bytes stand for what was
// written last, as the loader of a firmware needs it, or let the next write or setting fail.
class FuzzedTransport final : public test::MuteTransport {
 public:
  FuzzedTransport(std::span<const std::uint8_t>& input, DeviceClock& clock)
      : input_(input), clock_(clock) {}
  UsbResult claim(int) noexcept override {
    const int head = input_.empty() ? -1 : input_.front();
    if (head != 0xf6 && head != 0xf7 && !arms(head)) return UsbResult::ok;
    take();
    return head == 0xf6 ? UsbResult::failed : head == 0xf7 ? UsbResult::gone : UsbResult::ok;
  }
  UsbCount controlOut(const UsbRequest&, std::span<const std::byte>, unsigned) noexcept override {
    return {std::exchange(setting_, UsbResult::ok), 0};
  }
  UsbCount write(std::uint8_t, std::span<const std::byte> data, unsigned) noexcept override {
    last_.assign(data.begin(), data.end());
    if (data.size() == kFalconFrame && data[0] == std::byte{'<'}) {
      for (std::size_t motor = 0; motor < 3; ++motor) {
        unsigned value = 0;
        for (std::size_t i = 4; i-- > 0;)
          value = value << 4 | (std::to_integer<unsigned>(data[1 + 4 * motor + i]) - 0x41U);
        const int sent = static_cast<std::int16_t>(value);
        if (value > 0xffffU || std::abs(sent) > kMaxMotor) std::abort();
      }
    }
    return {std::exchange(writing_, UsbResult::ok), data.size()};
  }
  UsbCount read(std::uint8_t, std::span<std::byte> data, unsigned timeout_ms) noexcept override {
    int head = take();
    while (arms(head)) head = take();
    if (head < 0 || head == 0xff) {
      clock_.waitUntil(clock_.now() + 1e-3 * timeout_ms);
      return {UsbResult::timeout, 0};
    }
    if (head == 0xfe) return {UsbResult::stall, 0};
    if (head == 0xfd) return {UsbResult::gone, 0};
    if (head == 0xfc && last_.size() + 2 <= data.size()) {
      std::fill_n(data.begin(), 2, std::byte{1});
      std::copy(last_.begin(), last_.end(), data.begin() + 2);
      clock_.waitUntil(clock_.now() + 3e-4);
      return {UsbResult::ok, last_.size() + 2};
    }
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
  // Lets the next write or setting fail if the byte is one of the four that ask for it.
  bool arms(int head) {
    if (head < 0xf8 || head > 0xfb) return false;
    (head < 0xfa ? writing_ : setting_) = head % 2 == 0 ? UsbResult::gone : UsbResult::stall;
    return true;
  }
  std::span<const std::uint8_t>& input_;
  DeviceClock& clock_;
  std::vector<std::byte> last_;
  UsbResult writing_ = UsbResult::ok, setting_ = UsbResult::ok; // results of the next ones
};

// A file of zeros that is as long as a firmware.
FalconFirmwareSource firmware() {
  static const int file = memfd_create("firmware", 0);
  if (ftruncate(file, kMinFirmware) != 0) std::abort();
  return {"/proc/self/fd/" + std::to_string(file), "any"};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> input(data, size);
  const auto clock = std::make_shared<SimulatedClock>();
  const auto notes = std::make_shared<LinkStatistics>();
  LinkLoop loop(makeFalconLink([&] { return std::make_unique<FuzzedTransport>(input, *clock); },
                               firmware(), clock),
                falconGuard(), clock, notes);
  for (int turn = 0; turn < 400 && !input.empty(); ++turn) {
    const DeviceState& state = loop.step({Vec3(1, -2, 30), clock->now()});
    if (!state.position.allFinite() || !std::isfinite(state.age)) std::abort();
    if (state.status == DeviceStatus::ok && state.position.norm() > 1) std::abort();
    clock->waitUntil(clock->now() + 1e-3);
  }
  return 0;
}
