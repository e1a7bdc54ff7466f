#include "haptics/devices/falcon/falcon_device.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "haptics/devices/falcon/falcon_frame.h"
#include "haptics/devices/link/usb_opening.h"

namespace patina {
namespace {

constexpr double kAnswerWait = 2e-3; // [s]
constexpr double kSoonest = 2.1e-4;  // [s]: 16 bytes out, 16 back, at 1.5 Mbaud; sooner is old
constexpr double kSlowSend = 1e-4;   // [s]; after it, what is early looks as if it came in time
constexpr double kOwed = 0.01;       // [s], that an answer may be on its way
constexpr double kFastest = 2.5;     // [m/s], of a hand
constexpr double kJump = 2e-3;       // [m], that is none in itself: counts, and a late answer
constexpr double kLongGap = 4e-3;    // [s], after which a hand may have come anywhere
constexpr double kHomingTurn = 1;    // [s], of either way to ask for it
constexpr int kProbes = 3;
constexpr double kProbeWait = 0.03; // [s]

class FalconLink final : public DeviceLink {
 public:
  FalconLink(OpenTransport open, FalconFirmwareSource firmware, std::shared_ptr<DeviceClock> clock)
      : open_(std::move(open)), firmware_(std::move(firmware)), clock_(std::move(clock)) {}

  Opening open() noexcept override {
    try {
      return !line_ ? attach() : loader_ ? load() : probe();
    } catch (const std::exception&) {
      close();
      return failedOpening();
    }
  }

  DeviceState turn(const Vec3& force) noexcept override {
    if (!line_) return fault(DeviceStatus::gone);
    FalconCommand command;
    const bool lost = homed_ != kAllHomed;
    if (lost) command.homing = homingBit();
    command.lights = lost ? FalconLights::kRed : FalconLights::kGreen;
    if (!lost && !unsure_) command.motors = motorsFor(force);
    const double sent_at = clock_->now();
    if (const UsbResult result = line_->send(encoded(command)); result != UsbResult::ok)
      return fault(statusOf(result));
    ++owed_;
    if (unsure_) return settle(sent_at);
    const bool slow = clock_->now() - sent_at > kSlowSend;
    FalconBytes bytes;
    const LineRead read = line_->receive(bytes, kAnswerWait);
    hear(read.bytes + read.surplus, sent_at);
    if (read.result != UsbResult::ok) return fault(statusOf(read.result));
    if (read.surplus > 0 || clock_->now() - sent_at < kSoonest) return fault(DeviceStatus::garbled);
    const std::optional<FalconAnswer> answer = decoded(bytes);
    if (!answer) return fault(DeviceStatus::garbled);
    DeviceState state = stateOf(*answer);
    // It may be the answer to the frame before, which the next turn will show.
    if (slow && before_ >= 0) state.age = sent_at - before_;
    before_ = sent_at;
    return state;
  }

  void close() noexcept override {
    loader_.reset();
    line_.reset();
    unsure_ = false;
    owed_ = 0;
    homed_ = 0;
    probes_ = 0;
    loaded_ = false;
    place_at_ = before_ = -1;
  }

 private:
  Opening attach() {
    line_.emplace(open_(), clock_);
    if (const UsbResult result = line_->claim(); result != UsbResult::ok)
      throw DeviceError(
          result == UsbResult::gone
              ? "the Falcon went away while it was opened"
              : "the Falcon is held by another program or driver: close that program");
    if (line_->toRunning() != UsbResult::ok)
      throw DeviceError("the Falcon's line cannot be set: plug it in without a hub");
    return {};
  }

  // One frame without force: only a firmware answers it.
  Opening probe() {
    FalconBytes bytes;
    const UsbResult sent = line_->send(encoded({.lights = FalconLights::kRed}));
    if (sent == UsbResult::gone) throw DeviceError("the Falcon went away while it was opened");
    const LineRead read = line_->receive(bytes, kProbeWait);
    if (read.result == UsbResult::ok && read.surplus == 0 && decoded(bytes)) return {true, {}};
    if (line_->purge() != UsbResult::ok)
      throw DeviceError("the Falcon's line cannot be set: plug it in without a hub");
    if (++probes_ < kProbes) return {};
    if (loaded_) throw DeviceError("the Falcon took its firmware and does not answer: unplug it");
    if (firmware_.file.empty())
      throw DeviceError("the Falcon runs no firmware: set PATINA_FALCON_FIRMWARE to the maker's "
                        "file, which no other may ship (novint.bin or nvent.bin of its driver)");
    loader_.emplace(*line_, clock_, readFalconFirmware(firmware_.file, firmware_.trusted));
    return {};
  }

  Opening load() {
    switch (loader_->step()) {
    case FirmwareLoader::State::going:
      return {};
    case FirmwareLoader::State::refused:
      throw DeviceError(loader_->cause());
    case FirmwareLoader::State::loaded:
      break;
    }
    loader_.reset();
    probes_ = 0;
    loaded_ = true;
    if (line_->toRunning() != UsbResult::ok)
      throw DeviceError("the Falcon's line cannot be set: plug it in without a hub");
    return {};
  }

  std::array<std::int16_t, 3> motorsFor(const Vec3& force) const noexcept {
    if (place_at_ < 0) return {};
    const auto torques = falconTorques(shape_, pose_.handle, angles_, force);
    return torques ? motorValues(*torques, kMostMotor / kFalconFullTorque)
                   : std::array<std::int16_t, 3>{};
  }

  // The two by turns, until one of them has homed an axis.
  std::uint8_t homingBit() noexcept {
    const double now = clock_->now();
    if (homed_ == 0 && now - homing_since_ > kHomingTurn) {
      homing_ = 1 - homing_;
      homing_since_ = now;
    }
    return kHomingBits[homing_];
  }

  static DeviceStatus statusOf(UsbResult result) noexcept {
    return result == UsbResult::gone      ? DeviceStatus::gone
           : result == UsbResult::timeout ? DeviceStatus::silent
                                          : DeviceStatus::garbled;
  }

  // One that does not come in its turn may come later.
  void hear(std::size_t bytes, double sent_at) noexcept {
    const auto answers = static_cast<int>(bytes / kFalconFrame);
    if (answers < 1) owed_until_ = sent_at + kOwed;
    owed_ = std::max(owed_ - answers, 0);
  }

  DeviceState fault(DeviceStatus status) noexcept {
    unsure_ = true;
    DeviceState state;
    state.status = status;
    return state;
  }

  // What is owed comes, until nothing does.
  DeviceState settle(double sent_at) noexcept {
    const LineRead heard = line_->listen(sent_at + kLongestTurn - clock_->now());
    if (heard.result == UsbResult::gone) return fault(DeviceStatus::gone);
    hear(heard.surplus, sent_at);
    // Quiet after an answer to the frame of just now, and nothing older can be on its way.
    unsure_ = (owed_ > 0 && clock_->now() < owed_until_) ||
              !(heard.result == UsbResult::ok && heard.surplus >= kFalconFrame &&
                heard.surplus % kFalconFrame == 0);
    if (!unsure_) owed_ = 0;
    DeviceState state;
    state.status = DeviceStatus::silent;
    return state;
  }

  DeviceState stateOf(const FalconAnswer& answer) noexcept {
    homed_ = answer.homed;
    DeviceState state;
    state.buttons = answer.buttons;
    if (homed_ != kAllHomed) {
      place_at_ = -1;
      state.status = DeviceStatus::calibrating;
      return state;
    }
    for (std::size_t i = 0; i < 3; ++i)
      angles_[static_cast<int>(i)] = kFalconIndex + kFalconCount * answer.encoders[i];
    const double now = clock_->now(), gap = now - place_at_;
    const bool first = place_at_ < 0, lone = first || gap > kLongGap;
    const FalconPose pose =
        falconPose(shape_, angles_, lone ? std::nullopt : std::optional(pose_.handle));
    if (pose.singular || pose.residual > kFalconResidual) return fault(DeviceStatus::garbled);
    if (!lone && (pose.handle - pose_.handle).norm() > kJump + kFastest * gap)
      return fault(DeviceStatus::garbled);
    pose_ = pose;
    place_at_ = now;
    state.position = pose.handle - kFalconCentre;
    // There is nothing near to hold it against: it may be spoilt, and the next one tells.
    if (lone) state.status = first ? DeviceStatus::calibrating : DeviceStatus::silent;
    return state;
  }

  OpenTransport open_;
  FalconFirmwareSource firmware_;
  std::shared_ptr<DeviceClock> clock_;
  std::optional<FalconLine> line_;
  std::optional<FirmwareLoader> loader_;
  FalconShape shape_;
  FalconPose pose_;
  Angles angles_ = Angles::Zero();
  double place_at_ = -1;   // [s]; below 0: its place is not known
  double before_ = -1;     // [s], when the last frame was sent that was answered; below 0: none was
  double owed_until_ = -1; // [s]
  int owed_ = 0;           // answers that have not come
  std::uint8_t homed_ = 0;
  std::size_t homing_ = 1; // of kHomingBits; its first turn is over at once
  double homing_since_ = -2 * kHomingTurn;
  int probes_ = 0;
  bool loaded_ = false; // a firmware, since it was attached
  bool unsure_ = false; // an answer may be on its way that is not the newest
};

} // namespace

GuardSpec falconGuard() {
  GuardSpec guard;
  guard.max_force = 4.5;
  guard.workspace = kFalconWorkspace;
  guard.motors = {.continuous = 3, .time_constant = 60};
  return guard;
}

std::unique_ptr<DeviceLink> makeFalconLink(OpenTransport open, FalconFirmwareSource firmware,
                                           std::shared_ptr<DeviceClock> clock) {
  return std::make_unique<FalconLink>(std::move(open), std::move(firmware), std::move(clock));
}

} // namespace patina
