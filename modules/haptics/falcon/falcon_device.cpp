#include "haptics/falcon/falcon_device.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/file.h"
#include "core/sha256.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/link/usb_opening.h"

namespace patina {
namespace {

constexpr std::size_t kChunk = 62;
constexpr double kEchoWait = 0.2; // [s]; a late echo has arrived by then
constexpr double kHelloWait = 0.04;
constexpr int kHellos = 100,
              kRepeats = 8; // largest numbers of greetings, and of repeats of a chunk

constexpr std::byte operator""_b(unsigned long long value) {
  return static_cast<std::byte>(value);
}
constexpr std::array kHello{0x0a_b, 0x43_b, 0x0d_b};
constexpr std::array kHelloAnswer{0x0a_b, 0x44_b, 0x2c_b, 0x0d_b};
constexpr std::array kSecond{0x41_b};

} // namespace

std::vector<std::byte> readFalconFirmware(const std::filesystem::path& file,
                                          const std::string& trusted) {
  const std::string text = readFile(file);
  std::ostringstream cause;
  if (text.size() < kMinFirmware || text.size() > kMaxFirmware) {
    cause << "is no firmware of a Falcon: it has " << text.size() << " bytes, a firmware has "
          << kMinFirmware << " to " << kMaxFirmware;
  } else if (trusted != "any") {
    const std::string digest = sha256(text);
    if (trusted.empty())
      cause << "this firmware is not verified: if its SHA-256 is that of the maker's file, "
               "set PATINA_FALCON_SHA256="
            << digest;
    else if (digest != trusted)
      cause << "is not the verified firmware: its SHA-256 is " << digest
            << ", PATINA_FALCON_SHA256 is " << trusted;
  }
  if (!cause.str().empty()) throw FileError(file.string(), 0, cause.str());
  std::vector<std::byte> image(text.size());
  std::ranges::transform(text, image.begin(), [](char c) { return static_cast<std::byte>(c); });
  return image;
}

FalconFirmwareSource falconFirmwareSource() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::string(text ? text : "");
  };
  return {value("PATINA_FALCON_FIRMWARE"), value("PATINA_FALCON_SHA256")};
}

FirmwareLoader::FirmwareLoader(FalconLine& line, std::shared_ptr<DeviceClock> clock,
                               std::vector<std::byte> image)
    : line_(line), clock_(std::move(clock)), image_(std::move(image)),
      until_(clock_->now() + kFirmwareTime) {}

FirmwareLoader::State FirmwareLoader::again(const std::string& why) noexcept {
  if (++attempts_ >= kFirmwareAttempts || clock_->now() >= until_) {
    cause_ = "the Falcon does not take its firmware: " + why + ", " + std::to_string(attempts_) +
             " times; take its power and USB plugs out and put them in again";
    return State::refused;
  }
  stage_ = Stage::reset;
  sent_ = 0;
  hellos_ = repeats_ = 0;
  return State::going;
}

FirmwareLoader::State FirmwareLoader::step() noexcept {
  switch (stage_) {
  case Stage::reset:
    if (const UsbResult result = line_.toBootLoader(); result != UsbResult::ok) {
      gone_ = result == UsbResult::gone;
      return again("its line cannot be set");
    }
    stage_ = Stage::hello;
    return State::going;
  case Stage::hello:
  case Stage::second_hello:
    return hello();
  case Stage::chunks:
    break;
  }
  return chunk();
}

FirmwareLoader::State FirmwareLoader::hello() noexcept {
  const bool first = stage_ == Stage::hello;
  const std::span<const std::byte> greeting =
      first ? std::span<const std::byte>(kHello) : std::span<const std::byte>(kSecond);
  const std::span<const std::byte> answer =
      first ? std::span<const std::byte>(kHelloAnswer) : std::span<const std::byte>(kSecond);
  if (hellos_++ >= kHellos || clock_->now() >= until_)
    return again("it does not answer a greeting");
  if (const UsbResult result = line_.send(greeting); result != UsbResult::ok) {
    gone_ = result == UsbResult::gone;
    return gone_ ? again("it is gone") : State::going;
  }
  std::array<std::byte, 5> got{}; // a zero may precede the first reply
  const LineRead read = line_.receive(std::span(got).first(first ? 5 : 1), kHelloWait);
  const auto end = got.begin() + static_cast<std::ptrdiff_t>(read.bytes);
  if (std::search(got.begin(), end, answer.begin(), answer.end()) == end) return State::going;
  hellos_ = 0;
  if (!first) {
    stage_ = Stage::chunks;
    return State::going;
  }
  if (line_.toLoading() != UsbResult::ok) return again("its line cannot be set");
  stage_ = Stage::second_hello;
  return State::going;
}

FirmwareLoader::State FirmwareLoader::chunk() noexcept {
  const std::size_t size = std::min(kChunk, image_.size() - sent_);
  const std::span<const std::byte> chunk = std::span(image_).subspan(sent_, size);
  if (clock_->now() >= until_) return again("it takes too long");
  if (const UsbResult result = line_.send(chunk); result != UsbResult::ok) {
    gone_ = result == UsbResult::gone;
    if (gone_) return again("it is gone");
  }
  std::array<std::byte, kChunk> echo{};
  const LineRead read = line_.receive(std::span(echo).first(size), kEchoWait);
  const std::string where = "chunk " + std::to_string(sent_ / kChunk + 1) + " of " +
                            std::to_string((image_.size() + kChunk - 1) / kChunk);
  if (read.result == UsbResult::timeout && read.bytes == 0) {
    if (++repeats_ > kRepeats) return again(where + " never came back");
    return State::going; // sends the chunk again
  }
  if (read.bytes != size || read.surplus > 0 ||
      !std::ranges::equal(std::span(echo).first(size), chunk))
    return again(where + " came back changed");
  repeats_ = 0;
  sent_ += size;
  return sent_ == image_.size() ? State::loaded : State::going;
}

namespace {

constexpr double kReplyTimeout = 2e-3; // [s]
constexpr double kMinReplyTime =
    2.1e-4; // [s]: 16 bytes out and 16 back at 1.5 Mbaud; earlier replies are old
constexpr double kSlowSend = 1e-4;       // [s]; after a slower send an old reply looks timely
constexpr double kPendingReplies = 0.01; // time that a reply may be in flight [s]
constexpr double kMaxHandSpeed = 2.5;    // largest hand speed [m/s]
constexpr double kMaxPositionJump =
    2e-3;                           // tolerated position jump: encoder counts and a late reply [m]
constexpr double kLongGap = 4e-3;   // gap after which any position is possible [s]
constexpr double kHomingPeriod = 1; // time for either of the two homing bits [s]
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

  DeviceState exchange(const Vec3& force) noexcept override {
    if (!line_) return fault(DeviceStatus::gone);
    FalconCommand command;
    const bool lost = homed_ != kAllHomed;
    if (lost) command.homing = homingBit();
    command.lights = lost ? FalconLights::kRed : FalconLights::kGreen;
    if (!lost && !unsure_) command.motors = motorsFor(force);
    const double sent_at = clock_->now();
    if (const UsbResult result = line_->send(encoded(command)); result != UsbResult::ok)
      return fault(statusOf(result));
    ++pending_replies_;
    if (unsure_) return resynchronize(sent_at);
    const bool slow = clock_->now() - sent_at > kSlowSend;
    FalconBytes bytes;
    const LineRead read = line_->receive(bytes, kReplyTimeout);
    noteReply(read.bytes + read.surplus, sent_at);
    if (read.result != UsbResult::ok) return fault(statusOf(read.result));
    if (read.surplus > 0 || clock_->now() - sent_at < kMinReplyTime)
      return fault(DeviceStatus::protocol_error);
    const std::optional<FalconAnswer> answer = decoded(bytes);
    if (!answer) return fault(DeviceStatus::protocol_error);
    DeviceState state = stateOf(*answer);
    // The reply may belong to the previous frame; the next exchange will show it.
    if (slow && before_ >= 0) state.age = sent_at - before_;
    before_ = sent_at;
    return state;
  }

  void close() noexcept override {
    loader_.reset();
    line_.reset();
    unsure_ = false;
    pending_replies_ = 0;
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
              ? "the Falcon was unplugged while it was opened"
              : "the Falcon is held by another program or driver: close that program");
    if (line_->toRunning() != UsbResult::ok)
      throw DeviceError("the Falcon's line cannot be set: plug it in without a hub");
    return {};
  }

  // Sends one frame without force: only a firmware replies.
  Opening probe() {
    FalconBytes bytes;
    const UsbResult sent = line_->send(encoded({.lights = FalconLights::kRed}));
    if (sent == UsbResult::gone) throw DeviceError("the Falcon was unplugged while it was opened");
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
    return torques ? motorValues(*torques, kMaxMotor / kFalconFullTorque)
                   : std::array<std::int16_t, 3>{};
  }

  // Alternates between the two bits until one of them has homed an axis.
  std::uint8_t homingBit() noexcept {
    const double now = clock_->now();
    if (homed_ == 0 && now - homing_since_ > kHomingPeriod) {
      homing_ = 1 - homing_;
      homing_since_ = now;
    }
    return kHomingBits[homing_];
  }

  static DeviceStatus statusOf(UsbResult result) noexcept {
    return result == UsbResult::gone      ? DeviceStatus::gone
           : result == UsbResult::timeout ? DeviceStatus::timed_out
                                          : DeviceStatus::protocol_error;
  }

  // Records replies. A reply that misses its exchange may still arrive later.
  void noteReply(std::size_t bytes, double sent_at) noexcept {
    const auto answers = static_cast<int>(bytes / kFalconFrame);
    if (answers < 1) pending_until_ = sent_at + kPendingReplies;
    pending_replies_ = std::max(pending_replies_ - answers, 0);
  }

  DeviceState fault(DeviceStatus status) noexcept {
    unsure_ = true;
    DeviceState state;
    state.status = status;
    return state;
  }

  // Waits until no replies are outstanding.
  DeviceState resynchronize(double sent_at) noexcept {
    const LineRead heard = line_->listen(sent_at + kMaxExchangeTime - clock_->now());
    if (heard.result == UsbResult::gone) return fault(DeviceStatus::gone);
    noteReply(heard.surplus, sent_at);
    // The line is quiet after a reply to the last frame, and no older one can be in flight.
    unsure_ = (pending_replies_ > 0 && clock_->now() < pending_until_) ||
              !(heard.result == UsbResult::ok && heard.surplus >= kFalconFrame &&
                heard.surplus % kFalconFrame == 0);
    if (!unsure_) pending_replies_ = 0;
    DeviceState state;
    state.status = DeviceStatus::timed_out;
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
    if (pose.singular || pose.residual > kFalconResidual)
      return fault(DeviceStatus::protocol_error);
    if (!lone && (pose.handle - pose_.handle).norm() > kMaxPositionJump + kMaxHandSpeed * gap)
      return fault(DeviceStatus::protocol_error);
    pose_ = pose;
    place_at_ = now;
    state.position = pose.handle - kFalconCentre;
    // A lone position has no neighbour to check against; the next one must confirm it.
    if (lone) state.status = first ? DeviceStatus::calibrating : DeviceStatus::timed_out;
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
  double place_at_ = -1;      // [s]; below 0: position unknown
  double before_ = -1;        // time of the last answered frame [s]; below 0: none
  double pending_until_ = -1; // [s]
  int pending_replies_ = 0;   // outstanding replies
  std::uint8_t homed_ = 0;
  std::size_t homing_ = 1; // index into kHomingBits; the first period ends at once
  double homing_since_ = -2 * kHomingPeriod;
  int probes_ = 0;
  bool loaded_ = false; // firmware loaded since the device was attached
  bool unsure_ = false; // an outdated reply may be in flight
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
