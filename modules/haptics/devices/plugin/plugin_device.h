// A device behind a plug-in, so that no fault of the plug-in's is the loop's.
#pragma once

#include <memory>
#include <string>

#include "haptics/devices/link/linked_device.h"
#include "haptics/devices/plugin/patina_device.h"

namespace patina {

// A turn that took longer is a fault: its force was that of another place. [s]
inline constexpr double kLatePlugin = 4e-3;

// The plug-in is opened, turned with and closed in the link's thread, below the servo's priority.
// An answer that is none (an error, a number that is not finite, a place further than 10 m, no
// orientation, a late one) is a fault of its turn, and a plug-in that throws is not called again.
// `plugin` outlives it.
std::unique_ptr<DeviceLink> makePluginLink(const patina_device& plugin, std::string argument);

// "plugin:NAME" or "plugin:NAME:ARGUMENT", with what it says of its workspace and its force in its
// guard. Throws Error, and DeviceError where there is none of this name or it cannot be used.
std::unique_ptr<Device> makePluginDevice(std::string_view device, LinkedSpec spec = {});

} // namespace patina
