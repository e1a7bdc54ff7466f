// Any reports of a SpaceMouse, each after its length, give a cap of finite, bounded counts, and a
// tip that moves no faster than the cap can push it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "haptics/spacemouse/spacemouse.h"
#include "support/mute_transport.h"

namespace {

using namespace patina;

// The length of a report that stands at the start of `input`, without the length's own byte.
std::size_t lengthAt(std::span<const std::uint8_t> input) {
  return std::min<std::size_t>(input[0] & 0x3f, input.size() - 1);
}

// Each read takes a length and as many bytes; 0xc0 and more instead of a length is a failure.
class FuzzedCap final : public test::MuteTransport {
 public:
  FuzzedCap(std::span<const std::uint8_t>& input, SimulatedClock& clock)
      : input_(input), clock_(clock) {}
  UsbResult claim(int) noexcept override {
    return input_.empty() || input_[0] != 0xc0 ? UsbResult::ok : UsbResult::failed;
  }
  UsbCount write(std::uint8_t, std::span<const std::byte>, unsigned) noexcept override {
    std::abort(); // A SpaceMouse has nothing to be told.
  }
  UsbCount read(std::uint8_t, std::span<std::byte> data, unsigned timeout_ms) noexcept override {
    if (input_.empty()) return {UsbResult::gone, 0};
    const unsigned head = input_[0];
    const bool fails = head >= 0xc0;
    const std::size_t size = fails ? 0 : lengthAt(input_);
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::byte>(input_[1 + i]);
    input_ = input_.subspan(1 + size);
    clock_.waitUntil(clock_.now() + 1e-3 * timeout_ms * (fails ? 30 : 1));
    if (!fails) return {UsbResult::ok, size};
    return {head == 0xfe   ? UsbResult::stall
            : head == 0xfd ? UsbResult::gone
                           : UsbResult::timeout,
            0};
  }

 private:
  std::span<const std::uint8_t>& input_;
  SimulatedClock& clock_;
};

void checkReports(std::span<const std::uint8_t> input) {
  CapState cap;
  while (!input.empty()) {
    const std::size_t length = lengthAt(input);
    const CapState before = cap;
    const auto* report = reinterpret_cast<const std::byte*>(input.data() + 1);
    const bool taken = takeReport({report, length}, cap);
    if (!taken && (cap.translation != before.translation || cap.rotation != before.rotation ||
                   cap.buttons != before.buttons))
      std::abort();
    if (!(cap.translation.lpNorm<Eigen::Infinity>() <= 500 &&
          cap.rotation.lpNorm<Eigen::Infinity>() <= 500))
      std::abort();
    input = input.subspan(1 + length);
  }
}

void checkTip(std::span<const std::uint8_t> input) {
  const auto clock = std::make_shared<SimulatedClock>();
  const SpaceMouseSpec spec;
  const auto link =
      makeSpaceMouseLink([&] { return std::make_unique<FuzzedCap>(input, *clock); }, spec, clock);
  if (link->exchange(Vec3::Zero()).status != DeviceStatus::gone) std::abort();
  if (!link->open().answers) return;
  Vec3 last = spec.start;
  while (!input.empty()) {
    const DeviceState state = link->exchange(Vec3::Zero());
    if (state.status == DeviceStatus::ok) {
      if (!((state.position - last).norm() <= 0.02 * 3 * spec.speed)) std::abort();
      if (!(std::abs(state.orientation.norm() - 1) < 1e-6)) std::abort();
      last = state.position;
    }
  }
  link->close();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  checkReports({data, size});
  checkTip({data, size});
  return 0;
}
