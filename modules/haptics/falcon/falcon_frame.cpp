#include "haptics/falcon/falcon_frame.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr unsigned kBase = 0x41; // each byte between the brackets is its value plus this
constexpr std::byte kFirst{'<'}, kLast{'>'};
constexpr std::size_t kInfo = 13;

std::byte letter(unsigned value) {
  return static_cast<std::byte>(value + kBase);
}

} // namespace

FalconBytes encoded(const FalconCommand& command) noexcept {
  FalconBytes bytes;
  bytes.fill(letter(0));
  bytes.front() = kFirst;
  bytes.back() = kLast;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = static_cast<std::uint16_t>(command.motors[axis]);
    for (std::size_t nibble = 0; nibble < 4; ++nibble)
      bytes[1 + 4 * axis + nibble] = letter(value >> 4 * nibble & 0xfU);
  }
  bytes[kInfo] = letter((command.lights & 0x0eU) | (command.homing & 0x11U));
  return bytes;
}

std::optional<FalconAnswer> decoded(std::span<const std::byte, kFalconFrame> bytes) noexcept {
  if (bytes.front() != kFirst || bytes.back() != kLast) return std::nullopt;
  FalconAnswer answer;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    unsigned value = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      const unsigned part = std::to_integer<unsigned>(bytes[1 + 4 * axis + nibble]) - kBase;
      if (part > 0xfU) return std::nullopt; // below the base, too
      value |= part << 4 * nibble;
    }
    answer.encoders[axis] = static_cast<std::int16_t>(value);
  }
  const unsigned info = std::to_integer<unsigned>(bytes[kInfo]) - kBase;
  if (info > 0x7fU) return std::nullopt;
  answer.buttons = static_cast<std::uint8_t>(info & 0xfU);
  answer.homed = static_cast<std::uint8_t>(info >> 4);
  return answer;
}

std::array<std::int16_t, 3> motorValues(const Vec3& torques, double values_per_torque) noexcept {
  const double most = torques.lpNorm<Eigen::Infinity>();
  if (!torques.allFinite() || !(values_per_torque > 0)) return {};
  const double fits = static_cast<double>(kMaxMotor) / values_per_torque;
  const double scale = most > fits ? static_cast<double>(kMaxMotor) / most : values_per_torque;
  std::array<std::int16_t, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Truncates towards zero, so that rounding never increases a torque.
    const double value =
        std::clamp(torques[static_cast<int>(i)] * scale, -static_cast<double>(kMaxMotor),
                   static_cast<double>(kMaxMotor));
    values[i] = static_cast<std::int16_t>(value);
  }
  return values;
}

} // namespace patina
