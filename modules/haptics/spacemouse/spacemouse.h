// 3Dconnexion SpaceMouse: a cap with six axes that moves the tip.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "haptics/link/device_clock.h"
#include "haptics/link/device_link.h"
#include "usb/usb_transport.h"

namespace patina {

inline constexpr double kSpaceMouseFull = 350; // counts at full deflection
inline constexpr double kSpaceMouseDead = 8;   // dead zone [counts]

// Axes of a user at the desk: x right, y up, z towards the user; counts.
struct CapState {
  Vec3 translation = Vec3::Zero();
  Vec3 rotation = Vec3::Zero(); // about the same axes, right-handed
  std::uint32_t buttons = 0;
};
// Updates the state from a report: six axes at once (newer devices), translation or rotation (older
// ones), or buttons. Returns false and changes nothing for other reports.
bool takeReport(std::span<const std::byte> report, CapState& cap) noexcept;

struct SpaceMouseSpec {
  Vec3 start = Vec3::Zero(); // start of the tip [m]
  double speed = 0.1;        // at full deflection [m/s]
  double turn_speed = 1.5;   // at full deflection [rad/s]
};

// The tip's velocity is proportional to the deflection; no force is rendered. A released cap
// reports zero once; silence longer than the report interval also counts as released.
std::unique_ptr<DeviceLink> makeSpaceMouseLink(std::function<std::unique_ptr<UsbTransport>()> open,
                                               const SpaceMouseSpec& spec,
                                               std::shared_ptr<DeviceClock> clock);

} // namespace patina
