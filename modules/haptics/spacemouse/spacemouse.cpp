#include "haptics/spacemouse/spacemouse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "haptics/link/usb_opening.h"

namespace patina {
namespace {

constexpr std::uint8_t kReportPipe = 0x81;
constexpr double kMost = 500; // counts; larger values are clamped
constexpr double kReleased =
    60e-3; // time without a report after which the cap counts as released [s]
constexpr double kLongestPeriod = 0.02; // longest integration step [s]

double count(std::span<const std::byte> report, std::size_t at) {
  const unsigned value =
      std::to_integer<unsigned>(report[at]) | std::to_integer<unsigned>(report[at + 1]) << 8;
  return std::clamp<double>(static_cast<std::int16_t>(value), -kMost, kMost);
}

// Device axes: x right, y towards the user, z down.
Vec3 axesAt(std::span<const std::byte> report, std::size_t at) {
  return {count(report, at), -count(report, at + 4), count(report, at + 2)};
}

double pushed(double counts) {
  const double past = std::abs(counts) - kSpaceMouseDead;
  return past > 0 ? std::copysign(past / (kSpaceMouseFull - kSpaceMouseDead), counts) : 0;
}

class SpaceMouseLink final : public DeviceLink {
 public:
  SpaceMouseLink(std::function<std::unique_ptr<UsbTransport>()> open, const SpaceMouseSpec& spec,
                 std::shared_ptr<DeviceClock> clock)
      : open_(std::move(open)), spec_(spec), clock_(std::move(clock)) {
    state_.position = spec.start;
  }

  Opening open() noexcept override {
    try {
      usb_ = open_();
      if (usb_->claim(0) != UsbResult::ok)
        throw DeviceError("the SpaceMouse is held by another program: close it, or spacenavd");
    } catch (const std::exception&) {
      close();
      return failedOpening();
    }
    cap_ = {};
    at_ = heard_at_ = clock_->now();
    return {true, {}};
  }

  DeviceState exchange(const Vec3&) noexcept override {
    DeviceState failed;
    failed.status = DeviceStatus::gone;
    if (!usb_) return failed;
    std::array<std::byte, 64> report;
    const UsbCount got = usb_->read(kReportPipe, report, 1);
    if (got.result != UsbResult::ok && got.result != UsbResult::timeout) {
      if (got.result != UsbResult::gone) failed.status = DeviceStatus::protocol_error;
      return failed;
    }
    const double now = clock_->now();
    const std::size_t size = std::min(got.bytes, report.size());
    if (got.result == UsbResult::ok && takeReport(std::span(report).first(size), cap_))
      heard_at_ = now;
    if (now - heard_at_ > kReleased) cap_.translation = cap_.rotation = Vec3::Zero();
    move(std::clamp(now - at_, 0.0, kLongestPeriod));
    at_ = now;
    return state_;
  }

  void close() noexcept override { usb_.reset(); }

 private:
  void move(double dt) noexcept {
    const Vec3 speed = spec_.speed * cap_.translation.unaryExpr(&pushed);
    const Vec3 turned = dt * spec_.turn_speed * cap_.rotation.unaryExpr(&pushed);
    state_.position += dt * speed;
    state_.velocity = speed;
    if (const double angle = turned.norm(); angle > 0)
      state_.orientation =
          (Eigen::AngleAxisd(angle, turned / angle) * state_.orientation).normalized();
    state_.buttons = cap_.buttons;
  }

  std::function<std::unique_ptr<UsbTransport>()> open_;
  SpaceMouseSpec spec_;
  std::shared_ptr<DeviceClock> clock_;
  std::unique_ptr<UsbTransport> usb_;
  CapState cap_;
  DeviceState state_;
  double heard_at_ = 0, at_ = 0; // [s]
};

} // namespace

bool takeReport(std::span<const std::byte> report, CapState& cap) noexcept {
  if (report.empty()) return false;
  switch (std::to_integer<int>(report[0])) {
  case 1:
    if (report.size() != 7 && report.size() < 13) return false;
    cap.translation = axesAt(report, 1);
    if (report.size() >= 13) cap.rotation = axesAt(report, 7);
    return true;
  case 2:
    if (report.size() != 7) return false;
    cap.rotation = axesAt(report, 1);
    return true;
  case 3:
    if (report.size() < 2) return false;
    cap.buttons = 0;
    for (std::size_t i = 1; i < std::min<std::size_t>(report.size(), 5); ++i)
      cap.buttons |= std::to_integer<std::uint32_t>(report[i]) << 8 * (i - 1);
    return true;
  default:
    return false;
  }
}

std::unique_ptr<DeviceLink> makeSpaceMouseLink(std::function<std::unique_ptr<UsbTransport>()> open,
                                               const SpaceMouseSpec& spec,
                                               std::shared_ptr<DeviceClock> clock) {
  return std::make_unique<SpaceMouseLink>(std::move(open), spec, std::move(clock));
}

} // namespace patina
