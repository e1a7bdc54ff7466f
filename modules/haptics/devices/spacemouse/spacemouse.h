// A 3Dconnexion SpaceMouse: a cap that is pushed and turned, and what it does with the tip.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "haptics/devices/link/device_clock.h"
#include "haptics/devices/link/device_link.h"
#include "usb/usb_transport.h"

namespace patina {

inline constexpr double kSpaceMouseFull = 350; // counts of a cap that is pushed all the way
inline constexpr double kSpaceMouseDead = 8;   // counts, of a cap at rest: they move nothing

// As a hand at the desk sees it: x right, y up, z towards the person; counts.
struct CapState {
  Vec3 shift = Vec3::Zero();
  Vec3 turn = Vec3::Zero(); // about the same axes, right-handed
  std::uint32_t buttons = 0;
};
// Takes a report into the state. Newer devices send six axes in one, older ones shift and turn
// apart; buttons come by themselves. False, and no change, for what is none of these.
bool takeReport(std::span<const std::byte> report, CapState& cap) noexcept;

struct SpaceMouseSpec {
  Vec3 start = Vec3::Zero(); // [m], of the tip
  double speed = 0.1;        // [m/s], of a cap that is pushed all the way
  double turn_speed = 1.5;   // [rad/s]
};

// The tip moves as fast as the cap is pushed; no force is rendered. A cap that is let go says so
// once: where that report is lost, silence for longer than that of a cap that is held counts as it.
std::unique_ptr<DeviceLink> makeSpaceMouseLink(std::function<std::unique_ptr<UsbTransport>()> open,
                                               const SpaceMouseSpec& spec,
                                               std::shared_ptr<DeviceClock> clock);

} // namespace patina
