// Encodes the 16 bytes that a Falcon receives a thousand times a second, and decodes its reply.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/types.h"

namespace patina {

inline constexpr std::size_t kFalconFrame = 16;
using FalconBytes = std::array<std::byte, kFalconFrame>;

struct FalconLights {
  static constexpr std::uint8_t kGreen = 0x02, kRed = 0x08;
};

struct FalconCommand {
  std::array<std::int16_t, 3> motors{};
  std::uint8_t lights = 0;
  std::uint8_t homing = 0; // 0, or one of kHomingBits to request homing
};
inline constexpr std::array<std::uint8_t, 2> kHomingBits{0x01, 0x10}; // documentation differs
FalconBytes encoded(const FalconCommand& command) noexcept;

struct FalconAnswer {
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t buttons = 0; // bit i: button i of the four
  std::uint8_t homed = 0;   // bit i: axis i
  bool operator==(const FalconAnswer&) const = default;
};
inline constexpr std::uint8_t kAllHomed = 7;
// Returns nullopt unless all 16 bytes are valid.
std::optional<FalconAnswer> decoded(std::span<const std::byte, kFalconFrame> bytes) noexcept;

inline constexpr std::int16_t kMaxMotor = 4095; // largest magnitude of a motor value

// Motor values for torques [N m]. If one exceeds kMaxMotor, all three are scaled, so that the force
// keeps its direction; non-finite torques give zeros. Never exceeds the limit.
std::array<std::int16_t, 3> motorValues(const Vec3& torques, double values_per_torque) noexcept;

} // namespace patina
