#include "haptics/falcon/emulated_falcon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "haptics/falcon/falcon_device.h"

namespace patina {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWriteTime = 20e-6; // duration of a bulk transfer [s]
constexpr double kLateAnswer = 8e-3; // [s]

// Thigh angle that closes the linkage, knee outwards, by the tangent half-angle formula.
double thighOf(const Vec3& p, int leg) {
  const double turn = (105 - 120 * leg) * kPi / 180;
  const double u = p.x() * std::cos(turn) + p.y() * std::sin(turn) - 0.02557;
  const double aside = p.y() * std::cos(turn) - p.x() * std::sin(turn) + 0.00191;
  const double ring = 0.0225 + std::sqrt(std::max(0.0, 0.1025 * 0.1025 - aside * aside));
  const double a = 0.12 * u, b = 0.12 * p.z();
  const double c = u * u + p.z() * p.z() + 0.0036 - ring * ring;
  const double root = std::sqrt(std::max(0.0, a * a + b * b - c * c));
  return 2 * std::atan2(c - a, b + root);
}

// Force of the three shafts' torques, by numerical derivatives of the angles.
Vec3 forceOf(const Vec3& p, const Vec3& torques) {
  constexpr double kStep = 1e-6;
  Vec3 force = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    for (int leg = 0; leg < 3; ++leg) {
      const Vec3 way = kStep * Vec3::Unit(axis);
      force[axis] += torques[leg] * (thighOf(p + way, leg) - thighOf(p - way, leg)) / (2 * kStep);
    }
  return force;
}

int lettersToNumber(std::span<const std::byte> bytes) {
  int value = 0;
  for (int i = 3; i >= 0; --i)
    value = value * 16 + (std::to_integer<int>(bytes[static_cast<std::size_t>(i)]) - 'A');
  return value >= 32768 ? value - 65536 : value;
}

void numberToLetters(int value, std::vector<std::byte>& into) {
  for (int i = 0; i < 4; ++i) {
    into.push_back(static_cast<std::byte>('A' + (value & 15)));
    value >>= 4;
  }
}

} // namespace

class EmulatedFalconTransport final : public UsbTransport {
 public:
  explicit EmulatedFalconTransport(FalconEmulator& emulator) : emulator_(emulator) {}
  UsbResult claim(int) noexcept override { return alive() ? UsbResult::ok : UsbResult::gone; }
  UsbCount controlOut(const UsbRequest& request, std::span<const std::byte>,
                      unsigned) noexcept override {
    if (!alive()) return {UsbResult::gone, 0};
    if (request.request_type != 0x40) return {UsbResult::stall, 0};
    emulator_.control(request.request, request.value);
    return {};
  }
  UsbCount controlIn(const UsbRequest&, std::span<std::byte>, unsigned) noexcept override {
    return {alive() ? UsbResult::stall : UsbResult::gone, 0};
  }
  UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                 unsigned) noexcept override {
    if (!alive()) return {UsbResult::gone, 0};
    if (endpoint != 0x02) return {UsbResult::stall, 0};
    const UsbResult result = emulator_.write(data);
    return {result, result == UsbResult::ok ? data.size() : 0};
  }
  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                unsigned timeout_ms) noexcept override {
    if (!alive()) return {UsbResult::gone, 0};
    if (endpoint != 0x81 || data.size() < 2) return {UsbResult::stall, 0};
    return emulator_.read(data, timeout_ms);
  }

 private:
  // Once unplugged, a transport stays dead even if the device is attached again.
  bool alive() noexcept { return alive_ = alive_ && emulator_.attached(); }
  FalconEmulator& emulator_;
  bool alive_ = true;
};

FalconEmulator::FalconEmulator(const FalconEmulatorSpec& spec, std::shared_ptr<DeviceClock> clock)
    : spec_(spec), clock_(std::move(clock)), random_(spec.seed), runs_(spec.runs_firmware),
      homed_(0), step_(spec.body, 1e-3), moved_at_(clock_->now()) {
  loseHoming();
  if (spec.homed) {
    homed_ = 7;
    offset_ = {};
  }
  for (int leg = 0; leg < 3; ++leg)
    encoder_[static_cast<std::size_t>(leg)] = thighOf(kFalconCentre, leg);
}

std::unique_ptr<UsbTransport> FalconEmulator::plug() {
  if (!attached_) throw DeviceError("the emulated Falcon is not attached");
  to_host_.clear();
  buffer_.clear();
  from_host_.clear();
  withheld_.clear();
  stalled_ = false;
  return std::make_unique<EmulatedFalconTransport>(*this);
}

void FalconEmulator::loseHoming() noexcept {
  homed_ = 0;
  homing_for_ = 0;
  std::uniform_int_distribution<int> any(-900, 900);
  for (int& offset : offset_) offset = any(random_);
}

void FalconEmulator::control(std::uint8_t request, std::uint16_t value) noexcept {
  switch (request) {
  case 0:
    if (value == 1) { // data waiting for the host
      buffer_.clear();
      std::erase_if(to_host_, [now = clock_->now()](const Pending& p) { return p.due <= now; });
    }
    if (value == 2) from_host_.clear();
    break;
  case 1:
    if (value == 0x0101 && modem_ == 0x0100 && baud_ == 0x4138 && !runs_) { // reset
      greeted_ = 0;
      image_.clear();
    }
    modem_ = value;
    break;
  case 3:
    baud_ = value;
    break;
  case 9:
    latency_ = 1e-3 * std::max<int>(value, 1);
  }
}

UsbResult FalconEmulator::write(std::span<const std::byte> data) {
  clock_->waitUntil(clock_->now() + kWriteTime);
  if (faults.kind == WireFault::stall && faults.frames > 0) {
    --faults.frames;
    return UsbResult::stall;
  }
  if (!runs_) {
    boot(data);
    return UsbResult::ok;
  }
  from_host_.insert(from_host_.end(), data.begin(), data.end());
  while (from_host_.size() >= 16) {
    frame(std::span(from_host_).first(16));
    from_host_.erase(from_host_.begin(), from_host_.begin() + 16);
  }
  return UsbResult::ok;
}

void FalconEmulator::boot(std::span<const std::byte> data) {
  const auto is = [&](std::initializer_list<int> bytes) {
    return std::ranges::equal(data, bytes, {}, [](std::byte b) { return std::to_integer<int>(b); });
  };
  if (greeted_ == 0 && baud_ == 0x4138 && is({0x0a, 0x43, 0x0d})) {
    greeted_ = 1;
    return reply({std::byte{0}, std::byte{0x0a}, std::byte{0x44}, std::byte{0x2c}, std::byte{0x0d}},
                 10e-3);
  }
  if (baud_ != 0x15) return; // other baud rates give noise
  if (greeted_ == 1 && is({0x41})) {
    greeted_ = 2;
    return reply({std::byte{0x41}}, 1e-3);
  }
  if (greeted_ != 2) return;
  std::uniform_real_distribution<double> part(0, 1);
  const double lot = part(random_);
  if (lot < spec_.chunk_loss) return;
  std::vector<std::byte> echo(data.begin(), data.end());
  if (spec_.firmware.empty()) echo.front() ^= std::byte{0x10}; // simulates a rejection
  image_.insert(image_.end(), data.begin(), data.end());
  const double serial = 2 * 10 * static_cast<double>(data.size()) / 140e3;
  const bool late = lot < spec_.chunk_loss + spec_.chunk_late;
  reply(std::move(echo), serial + (late ? 0.15 * part(random_) : 0));
  runs_ = !spec_.firmware.empty() && image_ == spec_.firmware;
}

void FalconEmulator::frame(std::span<const std::byte> data) {
  advance();
  const auto letter = [&](std::size_t i) { return std::to_integer<int>(data[i]) - 'A'; };
  if (std::to_integer<char>(data[0]) != '<' || std::to_integer<char>(data[15]) != '>') return;
  ++frames_;
  for (std::size_t i = 0; i < 3; ++i) motors_[i] = lettersToNumber(data.subspan(1 + 4 * i, 4));
  if (on_frame) on_frame(clock_->now(), motors_);
  if (faults.kind == WireFault::homing_lost && faults.frames > 0) {
    --faults.frames;
    if (homed_ != 0) loseHoming();
  }
  const bool homing = (letter(13) & spec_.homing_bit) != 0;
  homing_for_ = homing ? homing_for_ + 1e-3 : 0;
  for (int axis = 0; axis < 3 && homing; ++axis)
    if (homing_for_ > (axis + 1) * spec_.homing_time / 3 && (homed_ >> axis & 1) == 0) {
      homed_ |= 1 << axis;
      offset_[static_cast<std::size_t>(axis)] = 0;
    }
  corrupt(answer());
}

std::vector<std::byte> FalconEmulator::answer() {
  std::vector<std::byte> bytes{std::byte{'<'}};
  const Vec3 place = lastHandle() + kFalconCentre; // what on_frame saw, however long ago that is
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double angle = thighOf(place, static_cast<int>(leg));
    encoder_[leg] =
        std::clamp(encoder_[leg], angle - spec_.backlash / 2, angle + spec_.backlash / 2);
    const double counts = (encoder_[leg] - kFalconIndex) / kFalconCount;
    numberToLetters((static_cast<int>(std::lround(counts)) + offset_[leg]) & 0xffff, bytes);
  }
  bytes.push_back(static_cast<std::byte>('A' + (homed_ << 4) + static_cast<int>(buttons & 0xfU)));
  bytes.push_back(std::byte{'A'});
  bytes.push_back(std::byte{'>'});
  return bytes;
}

void FalconEmulator::corrupt(std::vector<std::byte> bytes) {
  const std::vector<std::byte> before = std::exchange(before_, bytes);
  const WireFault kind = faults.frames > 0 ? faults.kind : WireFault::none;
  if (faults.frames > 0) --faults.frames;
  double after = spec_.answer;
  switch (kind) {
  case WireFault::mute:
    return;
  case WireFault::shortened:
    bytes.resize(11);
    break;
  case WireFault::corrupt:
    bytes[6] = std::byte{0xf3};
    break;
  case WireFault::flipped: // bit 1 of an encoder's third nibble: 512 counts
    bytes[7] = static_cast<std::byte>('A' + ((std::to_integer<int>(bytes[7]) - 'A') ^ 2));
    break;
  case WireFault::late:
    after = kLateAnswer;
    break;
  case WireFault::repeated:
    bytes.insert(bytes.end(), before_.begin(), before_.end());
    break;
  case WireFault::stale:
    reply(before, 0);
    break;
  case WireFault::out_of_order:
    withheld_ = std::move(bytes);
    return;
  case WireFault::noise:
    for (std::byte& b : bytes) b = static_cast<std::byte>(random_() & 0xffU);
    break;
  default:
    break;
  }
  reply(std::move(bytes), after);
  if (!withheld_.empty()) reply(std::exchange(withheld_, {}), after + 50e-6);
}

void FalconEmulator::reply(std::vector<std::byte> bytes, double after) {
  to_host_.push_back({clock_->now() + after, std::move(bytes)});
}

// A packet is sent as soon as data exist, or empty when the latency timer expires.
UsbCount FalconEmulator::read(std::span<std::byte> data, unsigned timeout_ms) {
  const double until = clock_->now() + 1e-3 * timeout_ms;
  const double empty_at = std::max(clock_->now(), last_packet_ + latency_);
  double soonest = empty_at;
  if (!buffer_.empty()) soonest = clock_->now();
  for (const Pending& pending : to_host_) soonest = std::min(soonest, pending.due);
  if (soonest > until) {
    clock_->waitUntil(until);
    return {UsbResult::timeout, 0};
  }
  clock_->waitUntil(soonest);
  const double now = clock_->now();
  for (const Pending& pending : to_host_)
    if (pending.due <= now)
      buffer_.insert(buffer_.end(), pending.bytes.begin(), pending.bytes.end());
  std::erase_if(to_host_, [now](const Pending& p) { return p.due <= now; });
  last_packet_ = now;
  const std::size_t taken = std::min({buffer_.size(), data.size() - 2, std::size_t{62}});
  data[0] = std::byte{0x01};
  data[1] = std::byte{0x60};
  std::copy_n(buffer_.begin(), taken, data.begin() + 2);
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken));
  return {UsbResult::ok, taken + 2};
}

void FalconEmulator::advance() noexcept {
  const double now = clock_->now();
  const double dt = std::clamp(now - moved_at_, 0.0, 0.1);
  moved_at_ = now;
  // Follows a change of the hand's rest position.
  for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)].x += anchor_[i] - rest[i];
  anchor_ = rest;
  Vec3 place = anchor_;
  for (int i = 0; i < 3; ++i) place[i] += axes_[static_cast<std::size_t>(i)].x;
  constexpr double kPerValue = kFalconFullTorque / 4095;
  force_ = forceOf(place + kFalconCentre, kPerValue * Vec3(motors_[0], motors_[1], motors_[2]));
  if (dt == 0) return;
  step_.setLength(dt);
  for (int i = 0; i < 3; ++i) {
    Motion& axis = axes_[static_cast<std::size_t>(i)];
    axis = step_(axis, force_[i] + push[i]);
    // Mechanical stops.
    const double most = kFalconWorkspace.max()[i] + 2e-3;
    const double at = anchor_[i] + axis.x;
    if (std::abs(at) > most) axis = {std::copysign(most, at) - anchor_[i], 0};
  }
}

Vec3 FalconEmulator::handle() noexcept {
  advance();
  return lastHandle();
}

Vec3 FalconEmulator::lastHandle() const noexcept {
  return anchor_ + Vec3(axes_[0].x, axes_[1].x, axes_[2].x);
}

Vec3 FalconEmulator::velocity() const noexcept {
  return {axes_[0].v, axes_[1].v, axes_[2].v};
}

} // namespace patina
