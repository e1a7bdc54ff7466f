// The 16 bytes that go to a Falcon a thousand times a second, and the 16 that come back.
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
  std::uint8_t homing = 0; // 0, or one of kHomingBits: the axes are to be homed
};
inline constexpr std::array<std::uint8_t, 2> kHomingBits{0x01, 0x10}; // sources differ
FalconBytes encoded(const FalconCommand& command) noexcept;

struct FalconAnswer {
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t buttons = 0; // bit i: button i of the four
  std::uint8_t homed = 0;   // bit i: axis i
  bool operator==(const FalconAnswer&) const = default;
};
inline constexpr std::uint8_t kAllHomed = 7;
// Absent unless all 16 bytes are what an answer has.
std::optional<FalconAnswer> decoded(std::span<const std::byte, kFalconFrame> bytes) noexcept;

inline constexpr std::int16_t kMostMotor = 4095; // of a motor's value, either way

// Motor values for torques [N m]. One that is more than kMostMotor scales all three down, so that
// the force keeps its direction; what is no number is none at all. Never above, never of another
// sign, whatever comes in.
std::array<std::int16_t, 3> motorValues(const Vec3& torques, double values_per_torque) noexcept;

} // namespace patina
