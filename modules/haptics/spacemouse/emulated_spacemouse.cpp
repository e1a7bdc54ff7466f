#include "haptics/spacemouse/emulated_spacemouse.h"

#include <algorithm>

#include "core/error.h"

namespace patina {
namespace {

class CapTransport final : public UsbTransport {
 public:
  CapTransport(std::shared_ptr<const EmulatedCap> cap, std::shared_ptr<DeviceClock> clock)
      : cap_(std::move(cap)), clock_(std::move(clock)), due_(clock_->now()) {}

  UsbResult claim(int) noexcept override { return alive() ? UsbResult::ok : UsbResult::gone; }
  UsbCount controlOut(const UsbRequest&, std::span<const std::byte>, unsigned) noexcept override {
    return {UsbResult::stall, 0};
  }
  UsbCount controlIn(const UsbRequest&, std::span<std::byte>, unsigned) noexcept override {
    return {UsbResult::stall, 0};
  }
  UsbCount write(std::uint8_t, std::span<const std::byte>, unsigned) noexcept override {
    return {UsbResult::stall, 0};
  }

  UsbCount read(std::uint8_t, std::span<std::byte> data, unsigned timeout_ms) noexcept override {
    const double until = clock_->now() + 1e-3 * timeout_ms;
    while (alive() && due_ <= until) {
      clock_->waitUntil(due_);
      due_ += cap_->two_reports ? 4e-3 : 16e-3;
      report_.clear();
      makeReport(cap_->hand(clock_->now()));
      if (report_.empty()) continue; // a cap at rest sends nothing
      const std::size_t size = std::min(report_.size(), data.size());
      std::copy_n(report_.begin(), size, data.begin());
      return {UsbResult::ok, size};
    }
    if (!alive_) return {UsbResult::gone, 0};
    clock_->waitUntil(until);
    return {UsbResult::timeout, 0};
  }

 private:
  bool alive() noexcept { return alive_ = alive_ && cap_->attached; }

  void makeReport(const CapState& cap) {
    if (cap.buttons != buttons_) {
      buttons_ = cap.buttons;
      report_ = {std::byte{3}, static_cast<std::byte>(buttons_ & 0xffU),
                 static_cast<std::byte>(buttons_ >> 8 & 0xffU)};
      return;
    }
    // The last report of a push contains zeros, in both formats.
    const bool still = cap.translation == Vec3::Zero() && cap.rotation == Vec3::Zero();
    reports_left_ = still ? reports_left_ - 1 : cap_->two_reports ? 2 : 1;
    if (reports_left_ < 0) {
      reports_left_ = 0;
      return;
    }
    if (!cap_->two_reports) {
      report_.push_back(std::byte{1});
      put(cap.translation);
      put(cap.rotation);
    } else {
      second_ = !second_;
      report_.push_back(second_ ? std::byte{2} : std::byte{1});
      put(second_ ? cap.rotation : cap.translation);
    }
  }

  void put(const Vec3& axes) {
    for (const double value : {axes.x(), axes.z(), -axes.y()}) {
      const auto bits = static_cast<std::uint16_t>(static_cast<std::int16_t>(value));
      report_.push_back(static_cast<std::byte>(bits & 0xffU));
      report_.push_back(static_cast<std::byte>(bits >> 8));
    }
  }

  std::shared_ptr<const EmulatedCap> cap_;
  std::shared_ptr<DeviceClock> clock_;
  double due_; // time of the next report [s]
  std::vector<std::byte> report_;
  std::uint32_t buttons_ = 0;
  int reports_left_ = 0;
  bool second_ = true, alive_ = true;
};

} // namespace

std::unique_ptr<UsbTransport> emulateSpaceMouse(std::shared_ptr<const EmulatedCap> cap,
                                                std::shared_ptr<DeviceClock> clock) {
  if (!cap->attached) throw DeviceError("the emulated SpaceMouse is not attached");
  return std::make_unique<CapTransport>(std::move(cap), std::move(clock));
}

} // namespace patina
