// The Novint Falcon: brought up, homed, and turned with, over any transport.
#pragma once

#include <functional>
#include <memory>

#include "haptics/devices/falcon/falcon_firmware.h"
#include "haptics/devices/falcon/falcon_kinematics.h"
#include "haptics/devices/link/device_link.h"
#include "haptics/devices/link/force_guard.h"

namespace patina {

// Where the device's own frame has its origin: the middle of the workspace, from the base [m].
inline const Vec3 kFalconCentre(0, 0, 0.12);
inline const Box3 kFalconWorkspace(Vec3(-0.05, -0.05, -0.045), Vec3(0.05, 0.05, 0.045));

inline constexpr double kFalconCount = 6.3589e-4;    // [rad] of a thigh, one count of its encoder
inline constexpr double kFalconIndex = 0.6108652382; // [rad], where an encoder counts zero: 35 deg
// Of a thigh at kMostMotor [N m]: what bears 8.9 N along z in the middle, the peak that the maker
// states.
inline constexpr double kFalconFullTorque = 0.2242;

// The force that the guard lets through: about half the peak, and what we take the motors to bear
// for ever. Neither is stated by the maker. The handle's weight is not borne.
GuardSpec falconGuard();

// Opens the bus and gives what is there. Throws DeviceError.
using OpenTransport = std::function<std::unique_ptr<UsbTransport>()>;

// Asks first whether a firmware runs, and loads the user's file only where none does. An answer
// counts only if it came alone, whole, in the time that it takes at least, and says a place where
// the hand can have come since the last; anything else is a fault, after which no answer counts
// before the line was quiet once and all that are owed have come, or had 10 ms for it. After
// 4 ms without a place the next one is not used, but the one after it must agree with it. Where
// sending took so long that an older answer would look as if it came in time, the state says the
// age that this one would have.
std::unique_ptr<DeviceLink> makeFalconLink(OpenTransport open, FalconFirmwareSource firmware,
                                           std::shared_ptr<DeviceClock> clock);

} // namespace patina
